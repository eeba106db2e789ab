// Walls without thickness: two faces back to back in one plane keep one side each.

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::kExact;
using test::meshed_area;
using test::reversed;
using test::TestRoom;
using test::worst_book_gap;
using testing::HasSubstr;
using testing::IsEmpty;

/// Area of the sides, looking up or down, that show a surface [m2].
double shown_area(const ZoneMesh& mesh, SurfaceId s, bool up) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.side_count(); ++i) {
    const SideId side(i);
    if (!mesh.has_zones(side) || mesh.surface(side) != s || (mesh.side_normal(side).z() > 0) != up) continue;
    sum += mesh.triangle_area(triangle_of(side));
  }
  return sum;
}

TEST(BackToBack, OpposedFacesOfTwoMaterialsKeepTheSideOfTheirFronts) {
  for (const bool two_sided : {false, true})
    for (const bool up_first : {false, true}) {
      TestRoom room;
      const MaterialId red = room.material(two_sided);
      const MaterialId white = room.material(two_sided);
      const auto outline = floor_rectangle(0, 0, 3, 2);
      SurfaceId up;
      if (up_first) up = room.polygon("up", red, outline);
      const SurfaceId down = room.polygon("down", white, reversed(outline));
      if (!up_first) up = room.polygon("up", red, outline);
      const MeshResult r = build_mesh(room.scene());
      EXPECT_EQ(r.report.back_to_back_faces, 1U);
      EXPECT_EQ(r.report.overlapping_faces, 0U);
      EXPECT_EQ(r.report.duplicate_faces, 0U);
      EXPECT_THAT(r.report.warnings, IsEmpty());
      EXPECT_NEAR(shown_area(r.mesh, up, true), 6, 6 * kExact);
      EXPECT_NEAR(shown_area(r.mesh, down, false), 6, 6 * kExact);
      EXPECT_EQ(shown_area(r.mesh, up, false), 0);
      EXPECT_EQ(shown_area(r.mesh, down, true), 0);
      EXPECT_LT(worst_book_gap(r), kExact);
      for (std::size_t z = 0; z < r.mesh.zone_count(); ++z) EXPECT_TRUE(r.mesh.zone_shows_front(ZoneId(z)));
    }
}

TEST(BackToBack, WhereTheyOverlapInPartTheRestStaysAsItWas) {
  TestRoom room;
  const SurfaceId up = room.polygon("up", room.material(), floor_rectangle(0, 0, 4, 4));
  const SurfaceId down = room.polygon("down", room.material(false), reversed(floor_rectangle(3, 1, 6, 2)));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 1U);
  EXPECT_THAT(r.report.warnings, IsEmpty());
  EXPECT_NEAR(shown_area(r.mesh, up, true), 16, 16 * kExact);
  EXPECT_NEAR(shown_area(r.mesh, up, false), 16 - 1, 16 * kExact) << "its own back but for the common part";
  EXPECT_NEAR(shown_area(r.mesh, down, false), 3, 3 * kExact);
  EXPECT_EQ(shown_area(r.mesh, down, true), 0) << "one-sided";
  EXPECT_NEAR(meshed_area(r.mesh, up), 16, 16 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, down), 3, 3 * kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(BackToBack, SameWindingLeavesTheEarlierFaceAndSaysWhatToDo) {
  TestRoom room;
  const SurfaceId first = room.polygon("first", room.material(), floor_rectangle(0, 0, 2, 2));
  const SurfaceId second = room.polygon("second", room.material(), floor_rectangle(1, 0, 3, 2));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 0U);
  EXPECT_NEAR(meshed_area(r.mesh, first), 4, 4 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, second), 2, 2 * kExact);
  ASSERT_EQ(r.report.warnings.size(), 1U);
  EXPECT_THAT(r.report.warnings[0], HasSubstr("keep one side each if their fronts look apart"));
}

// Of several that look to one side the earlier one has it, as ever.
TEST(BackToBack, AThirdFaceLosesToTheOneOfItsSide) {
  TestRoom room;
  const SurfaceId up = room.polygon("up", room.material(), floor_rectangle(0, 0, 4, 4));
  const SurfaceId down = room.polygon("down", room.material(), reversed(floor_rectangle(1, 1, 3, 3)));
  const SurfaceId below = room.polygon("below", room.material(), reversed(floor_rectangle(2, 2, 4, 4)));
  const SurfaceId above = room.polygon("above", room.material(), floor_rectangle(0, 0, 2, 2));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 2U);
  EXPECT_EQ(r.report.overlapping_faces, 2U);
  EXPECT_NEAR(shown_area(r.mesh, up, true), 16, 16 * kExact);
  EXPECT_NEAR(shown_area(r.mesh, up, false), 16 - 4 - 3, 16 * kExact);
  EXPECT_NEAR(shown_area(r.mesh, down, false), 4, 4 * kExact);
  EXPECT_NEAR(shown_area(r.mesh, below, false), 3, 3 * kExact);
  EXPECT_EQ(meshed_area(r.mesh, above), 0);
  EXPECT_LT(worst_book_gap(r), kExact);
  ASSERT_EQ(r.report.warnings.size(), 1U);
  EXPECT_THAT(r.report.warnings[0], HasSubstr("'up' covers 4 m2 of 'above'"));
  EXPECT_THAT(r.report.warnings[0], HasSubstr("'down' covers 1 m2 of 'below'"));
}

// What stands on a slab has the side inside of it, which nobody sees, not the underside of the slab.
TEST(BackToBack, ASolidOnASheetDoesNotShowBelowIt) {
  TestRoom room;
  const SurfaceId slab = room.polygon("slab", room.material(), floor_rectangle(0, 0, 4, 4));
  room.box("crate", room.material(), {1, 1, 0}, {2, 2, 1});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 0U);
  EXPECT_NEAR(shown_area(r.mesh, slab, false), 16, 16 * kExact);
}

// Rooms wall to wall, each drawn as a closed box that looks inwards.
TEST(BackToBack, RoomsThatShareAWallKeepTheirSides) {
  TestRoom room;
  const SurfaceId left = room.box("left", room.material(false), {0, 0, 0}, {2, 2, 2}, true);
  const SurfaceId right = room.box("right", room.material(false), {2, 0, 0}, {5, 3, 2}, true);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 1U);
  EXPECT_NEAR(meshed_area(r.mesh, left), 24, 24 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, right), 42, 42 * kExact);
  double zones = 0;
  for (std::size_t z = 0; z < r.mesh.zone_count(); ++z) zones += r.mesh.zone_area(ZoneId(z));
  EXPECT_NEAR(zones, 66, 66 * kExact);
}

TEST(BackToBack, LampsMirrorsAndPanesKeepBothSidesAsBefore) {
  const auto pairs_with = [](auto&& change) {
    TestRoom room;
    const MaterialId m = room.material();
    change(room.scene().materials[m.index()]);
    room.polygon("up", m, floor_rectangle(0, 0, 1, 1));
    room.polygon("down", room.material(), reversed(floor_rectangle(0, 0, 2, 1)));
    return build_mesh(room.scene()).report.back_to_back_faces;
  };
  EXPECT_EQ(pairs_with([](Material&) {}), 1U);
  EXPECT_EQ(pairs_with([](Material& m) { m.emitted_radiance[0] = 1; }), 0U);
  EXPECT_EQ(pairs_with([](Material& m) { m.non_diffuse.specular_reflectance = Spectrum::Constant(1, 0.3); }),
            0U);
  EXPECT_EQ(pairs_with([](Material& m) { m.non_diffuse.diffuse_transmittance = Spectrum::Constant(1, 0.3); }),
            0U);
}

TEST(BackToBack, OneMaterialOnBothSidesIsASheet) {
  TestRoom room;
  const MaterialId one_sided = room.material(false);
  room.polygon("up", one_sided, floor_rectangle(0, 0, 2, 1));
  const SurfaceId down = room.polygon("down", one_sided, reversed(floor_rectangle(1, 0, 3, 1)));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.back_to_back_faces, 1U) << "a back that absorbs is not that of a face drawn there";
  EXPECT_NEAR(shown_area(r.mesh, down, false), 2, 2 * kExact);
}

TEST(BackToBack, BacksOfATableThatIsNotOfTheMeshAreRefused) {
  TestRoom room;
  room.polygon("floor", room.material(false), floor_rectangle(0, 0, 1, 1));
  BaseMesh base = build_mesh(room.scene()).mesh.base();
  base.backs.resize(base.triangles.size() - 1);
  EXPECT_THROW(ZoneMesh{base}, std::invalid_argument);
  base.backs.assign(base.triangles.size(), {SurfaceId(0), 0});
  EXPECT_THROW(ZoneMesh{base}, std::invalid_argument) << "one-sided";
}

}  // namespace
}  // namespace reemit
