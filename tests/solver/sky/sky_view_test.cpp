#include "solver/sky/sky_view.h"

#include <gtest/gtest.h>

namespace reemit {
namespace {

// Ceilings lie where cells of the view meet in many a room, and rays start a little below them.
TEST(SkyView, PlacesOfSurfacesAreThoseOfTheirRayStarts) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float facing : {-1.0F, 1.0F})
      for (int edge = -8; edge <= 8; ++edge) {
        Vec3f normal(0, 0, 0);
        normal[axis] = facing;
        Vec3f x(0.3F, 0.3F, 0.3F);
        x[axis] = 0.125F * static_cast<float>(edge);
        SkyView view;
        const std::uint32_t place = view.add_place(x, normal);
        for (const float before : {-1e-6F, 0.0F, 1e-6F, 1e-4F, 1e-3F})
          EXPECT_EQ(view.place_of(x + before * normal, normal), place)
              << axis << " " << edge << " " << before;
        EXPECT_EQ(view.place_of(x, -normal), SkyView::kUnknown);
      }
}

// Corners of faces lie where cells meet as well, and beyond the face nothing has been learnt.
TEST(SkyView, CellsWithoutRaysSeeWhatTheirNeighboursSee) {
  const Vec3f down(0, 0, -1);
  SkyView view;
  const std::uint32_t place = view.add_place({0.1F, 0.1F, 0.5F}, down);
  view.add_ray(place);
  view.add_escape(place, {1, 0, 0}, 1);
  EXPECT_EQ(view.place_of({-0.001F, 0.1F, 0.5F}, down), SkyView::kUnknown);
  view.finish();
  EXPECT_EQ(view.place_of({-0.001F, 0.1F, 0.5F}, down), place);
  EXPECT_EQ(view.place_of({0.1F, 0.251F, 0.5F}, down), place);
  EXPECT_EQ(view.place_of({0.1F, 0.1F, 0.2F}, down), place);
  EXPECT_EQ(view.place_of({0.6F, 0.1F, 0.5F}, down), SkyView::kUnknown);
  EXPECT_EQ(view.place_of({-0.001F, 0.1F, 0.5F}, -down), SkyView::kUnknown);
}

}  // namespace
}  // namespace reemit
