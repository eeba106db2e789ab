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

/// Rays of a place that leave the room, all one way.
void see(SkyView& view, std::uint32_t place, int rays, const Vec3& towards) {
  for (int i = 0; i < rays; ++i) {
    view.add_ray(place);
    view.add_escape(place, towards, 1);
  }
}

/// Middles of cells of directions, in the frame of the sky.
const Vec3 kEast = Vec3(1, 0.1, 0.05).normalized();
const Vec3 kWest = Vec3(-1, 0.1, 0.05).normalized();
const Vec3 kNorth = Vec3(0.1, 1, 0.05).normalized();
const Vec3f kDown(0, 0, -1);
const Vec3f kUp(0, 0, 1);

double density(const SkyView& view, const Vec3f& x, const Vec3f& normal, const Vec3& towards) {
  return view.pdf_per_sr(view.place_of(x, normal), towards);
}

// Corners of faces lie where cells meet, and beyond the face no ray has started from a surface.
TEST(SkyView, CellsWithoutSurfacesSeeWhatTheirNeighboursAndTheAirSee) {
  SkyView view;
  see(view, view.add_place({0.1F, 0.1F, 0.5F}, kDown), 1000, kEast);
  view.add_air();
  for (std::size_t cell = 0; cell < 512; ++cell)
    for (std::size_t facing = 0; facing < SkyView::kFacings; ++facing)
      see(view, view.place_in_air(cell, facing), 1000, kWest);
  view.finish();
  const double own = density(view, {0.1F, 0.1F, 0.5F}, kDown, kEast);
  for (const Vec3f& beside :
       {Vec3f(-0.001F, 0.1F, 0.5F), Vec3f(0.1F, 0.251F, 0.5F), Vec3f(0.1F, 0.1F, 0.2F)}) {
    EXPECT_NEAR(density(view, beside, kDown, kEast), own / 2, 0.05 * own);
    EXPECT_NEAR(density(view, beside, kDown, kWest), own / 2, 0.05 * own);
  }
  for (const Vec3f& x : {Vec3f(0.6F, 0.1F, 0.5F), Vec3f(0.1F, 0.1F, -0.5F)})
    EXPECT_NEAR(density(view, x, kDown, kWest), own, 0.05 * own);
  EXPECT_NEAR(density(view, {0.1F, 0.1F, 0.5F}, kUp, kWest), own, 0.05 * own);
}

TEST(SkyView, WhatFewRaysCannotTellComesFromAround) {
  SkyView view;
  see(view, view.add_place({0.1F, 0.1F, 0.1F}, kDown), 1, kEast);      // a leg of a table
  view.add_ray(view.add_place({0.3F, 0.1F, 0.1F}, kDown));             // of another, and saw nothing
  see(view, view.add_place({-0.9F, -0.9F, -0.9F}, kUp), 1000, kWest);  // the floor
  view.add_air();
  for (std::size_t facing = 0; facing < SkyView::kFacings; ++facing)
    for (std::size_t cell = 0; cell < 512; ++cell) view.add_ray(view.place_in_air(cell, facing));
  see(view, view.place_in_air((4 * 8 + 4) * 8 + 4, 5), 1000, kNorth);  // of that cell, beyond the wall
  view.finish();
  ASSERT_TRUE(view.sees_sky());
  const double certain = density(view, {-0.9F, -0.9F, -0.9F}, kUp, kWest);
  const Vec3f leg(0.1F, 0.1F, 0.1F);
  // Its own ray is all that is known of surfaces around, too: each time it counts as one, what is known of
  // more as four.
  const double own = 1 - 0.8 * 0.8 * 0.8 * 0.8;
  EXPECT_NEAR(density(view, leg, kDown, kEast), own * certain, 0.1 * certain);
  EXPECT_NEAR(density(view, leg, kDown, kWest), (1 - own) * certain, 0.1 * certain);
  EXPECT_LT(density(view, leg, kDown, kNorth), 0.01 * certain);
  const Vec3f other(0.3F, 0.1F, 0.1F);
  EXPECT_NEAR(density(view, other, kDown, kEast), (1 - 0.8 * 0.8 * 0.8) * certain, 0.1 * certain);
  // Nobody faced so anywhere near.
  EXPECT_NEAR(density(view, {0.9F, 0.9F, 0.9F}, kUp, kWest), certain, 0.1 * certain);
}

TEST(SkyView, SharesOfDirectionsAreThoseOfSamples) {
  SkyView view;
  see(view, view.add_place({0.1F, 0.1F, 0.1F}, kDown), 20, kEast);
  see(view, view.add_place({-0.9F, -0.9F, -0.9F}, kDown), 1000, kWest);
  view.add_air();
  for (std::size_t facing = 0; facing < SkyView::kFacings; ++facing)
    for (std::size_t cell = 0; cell < 512; ++cell) view.add_ray(view.place_in_air(cell, facing));
  view.finish();
  const std::uint32_t place = view.place_of({0.1F, 0.1F, 0.1F}, kDown);
  // The mean of 1 / density over samples is the solid angle of all that can be drawn: at most the sphere.
  double sum = 0;
  int east = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 way = view.sample(place, (i + 0.5) / kDraws, 0.5);
    const double pdf = view.pdf_per_sr(place, way);
    ASSERT_GT(pdf, 0);
    sum += 1 / pdf / kDraws;
    if (way.dot(kEast) > 0) ++east;
  }
  EXPECT_LT(sum, 4 * 3.1416);
  EXPECT_GT(east, kDraws / 2);
  EXPECT_LT(east, kDraws);
}

TEST(SkyView, SeesNothingWhereNoRayMetLight) {
  SkyView view;
  view.add_ray(view.add_place({0.1F, 0.1F, 0.1F}, kDown));
  view.add_air();
  view.finish();
  EXPECT_FALSE(view.sees_sky());
}

}  // namespace
}  // namespace reemit
