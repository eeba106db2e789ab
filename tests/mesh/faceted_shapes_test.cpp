#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/shapes/room_shapes.h"
#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

using testing::HasSubstr;

/// A closed room of 4 m x 4 m x 4 m, into whose floor a cylinder is sunk.
struct SunkCylinder {
  explicit SunkCylinder(double radius, bool with_cap = false) {
    const MaterialId m = room.material();
    room.box("walls", m, {0, 0, 0}, {4, 4, 4}, true);
    rod = room.surface("rod", m);
    room.scene().surfaces[rod.index()].shapes.push_back(Cylinder{{2, 2, -0.5}, {2, 2, 1}, radius});
    if (!with_cap) return;
    cap = room.surface("cap", m);
    room.scene().surfaces[cap.index()].shapes.push_back(Disk{{2, 2, 1}, {0, 0, 1}, radius});
  }
  /// Flat faces of a surface after the shapes have been looked at.
  std::size_t faces(SurfaceId s, const MeshSettings& settings = {}) const {
    const RoomShapes shapes = separate(settings);
    return shapes.faceted ? shapes.faceted->surfaces[s.index()].faces.size() : 0;
  }
  RoomShapes separate(const MeshSettings& settings = {}) const {
    return separate_shapes(room.scene(), settings, MeshTolerances::of(bounds(room.scene())));
  }

  mutable test::TestRoom room;
  SurfaceId rod, cap;
};

TEST(FacetedShapes, SidesFollowTheSizeBesideThatOfZones) {
  EXPECT_EQ(SunkCylinder(0.001).faces(SurfaceId(1)), 8U);
  EXPECT_EQ(SunkCylinder(1.5).faces(SurfaceId(1)), 32U);
  const SunkCylinder rod(0.1);
  std::size_t before = 0;
  for (const double zone_area : {1.0, 0.01, 1e-4, 1e-6}) {
    const std::size_t sides = rod.faces(rod.rod, {.zone_area = zone_area});
    EXPECT_GE(sides, before) << zone_area;
    EXPECT_EQ(sides % 4, 0U);
    const double sagitta = 0.1 * (1 - std::cos(std::numbers::pi / static_cast<double>(sides)));
    if (sides < 32) {
      EXPECT_LE(sagitta, std::sqrt(zone_area) / 200) << zone_area;
    }
    before = sides;
  }
  EXPECT_EQ(before, 32U);
}

// A veil over a lamp: light passes through what is not there of a face, and patches know nothing of that.
TEST(FacetedShapes, CutOutsAreMadeOfFaces) {
  test::TestRoom room;
  const MaterialId veil = room.material();
  room.scene().materials[veil.index()].textures.opacity_factor = 0.3;
  const SurfaceId sphere = room.surface("veil", veil);
  room.scene().surfaces[sphere.index()].shapes.push_back(Sphere{{2, 2, 2}, 1});
  const MaterialId solid = room.material();
  room.box("walls", solid, {0, 0, 0}, {4, 4, 4}, true);
  const RoomShapes shapes = separate_shapes(room.scene(), {}, MeshTolerances::of(bounds(room.scene())));
  EXPECT_THAT(shapes.exact, testing::IsEmpty());
  ASSERT_TRUE(shapes.faceted);
  EXPECT_GT(shapes.faceted->surfaces[sphere.index()].faces.size(), 100U);
}

TEST(FacetedShapes, ThoseThatEndInOneCircleHaveItsCornersInCommon) {
  // The mantle is pierced; the cap follows it, and both get the number of the larger of them.
  const SunkCylinder rod(0.05, true);
  const RoomShapes shapes = rod.separate();
  ASSERT_TRUE(shapes.faceted);
  EXPECT_THAT(shapes.exact, testing::IsEmpty());
  const Surface& mantle = shapes.faceted->surfaces[rod.rod.index()];
  const Surface& cap = shapes.faceted->surfaces[rod.cap.index()];
  ASSERT_EQ(cap.faces.size(), 1U);
  EXPECT_EQ(cap.faces[0].outer.size(), mantle.faces.size());
  for (const Vec3& corner : cap.positions) {
    const auto nearest = std::ranges::min_element(mantle.positions, {},
                                                  [&](const Vec3& p) { return (p - corner).squaredNorm(); });
    EXPECT_LT((*nearest - corner).norm(), 1e-12);
  }
}

TEST(FacetedShapes, AConeAndACylinderInOneCircleHaveTheSidesOfTheWiderOne) {
  SunkCylinder rod(0.02);
  const SurfaceId foot = rod.room.surface("foot", rod.room.material());
  rod.room.scene().surfaces[foot.index()].shapes.push_back(Cone{{2, 2, 2}, {2, 2, 1}, 1.0, 0.02});
  EXPECT_EQ(rod.faces(rod.rod), 32U);
  EXPECT_EQ(rod.faces(foot), 32U);
}

TEST(FacetedShapes, ReportSaysHowMuchAreaTheyLost) {
  const SunkCylinder rod(0.001);
  const FacetedShapes& facets = rod.separate().facets;
  EXPECT_EQ(facets.count, 1U);
  EXPECT_EQ(facets.fewest_sides, 8);
  EXPECT_EQ(facets.most_sides, 8);
  // Chords of an eighth of a circle over its arc.
  EXPECT_NEAR(facets.flat_area / facets.round_area, 8 / std::numbers::pi * std::sin(std::numbers::pi / 8),
              1e-12);
  const MeshResult meshed = build_mesh(rod.room.scene());
  EXPECT_THAT(meshed.report.warnings,
              testing::Contains(AllOf(HasSubstr("1 round shape(s)"), HasSubstr("with 8 sides to a circle"),
                                      HasSubstr("2.6 % less area"))));
}

TEST(FacetedShapes, AllHaveThirtyTwoSidesWhereNoneMayStayRound) {
  const SunkCylinder rod(0.001);
  EXPECT_EQ(rod.faces(rod.rod, {.exact_shapes = false}), 32U);
}

}  // namespace
}  // namespace reemit
