#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "tests/mesh/test_room.h"

// Outlines that draw holes and islands by seams, edges walked there and back, as MGF files do.

namespace reemit {
namespace {

using test::floor_rectangle;
using test::kExact;
using test::meshed_area;
using test::reversed;
using test::TestRoom;
using test::worst_book_gap;

using Outline = std::vector<Vec3>;

/// `outer` walked round from its first corner, with a seam from there to `inner` and back.
Outline seamed(Outline outer, const Outline& inner, const Outline& way = {}) {
  const Vec3 first = outer.front();
  outer.push_back(first);
  outer.insert(outer.end(), way.begin(), way.end());
  outer.insert(outer.end(), inner.begin(), inner.end());
  outer.push_back(inner.front());
  outer.insert(outer.end(), way.rbegin(), way.rend());
  return outer;
}

Outline square(double x, double y, double size) {
  return floor_rectangle(x, y, x + size, y + size);
}

/// Meshes one face and checks its area, front and books, and that it covers just the points that `covered`
/// says, asked at the middles of its triangles.
void expect_region(const Outline& outline, double area, const std::function<bool(const Vec3&)>& covered,
                   const std::vector<Outline>& holes = {}) {
  TestRoom room;
  const SurfaceId s = room.polygon("face", room.material(), outline);
  for (const Outline& hole : holes) room.add_hole(s, hole);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(r.report.surfaces[0].input, area, area * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, s), area, area * kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_TRUE(r.report.warnings.empty());
  for (std::size_t t = 0; t < r.mesh.triangle_count(); ++t) {
    EXPECT_TRUE(covered(r.mesh.point(TriangleId(t), 1.0 / 3, 1.0 / 3)));
    EXPECT_GT(r.mesh.triangle_normal(TriangleId(t)).z(), 0.999);
  }
}

bool in_square(const Vec3& p, double x, double y, double size) {
  return p.x() > x && p.x() < x + size && p.y() > y && p.y() < y + size;
}

TEST(Seams, HoleOfEitherWindingIsAHole) {
  for (const bool turned : {false, true}) {
    const Outline hole = turned ? reversed(square(1, 1, 1)) : square(1, 1, 1);
    const auto ring = [](const Vec3& p) { return in_square(p, 0, 0, 4) && !in_square(p, 1, 1, 1); };
    expect_region(seamed(square(0, 0, 4), hole), 15, ring);
    expect_region(seamed(square(0, 0, 4), hole, {{0.5, 0.8, 0}, {0.7, 0.2, 0}}), 15, ring);
    // Starting to read in the middle of the hole must not matter.
    Outline turned_round = seamed(square(0, 0, 4), hole);
    std::rotate(turned_round.begin(), turned_round.begin() + 7, turned_round.end());
    expect_region(turned_round, 15, ring);
  }
}

TEST(Seams, SeamOfOneEdgeOnTheWayThereAndOfTwoOnTheWayBack) {
  Outline outline = square(0, 0, 4);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 1, 0), Vec3(2, 2, 0), Vec3(1, 2, 0),
                        Vec3(1, 1, 0), Vec3(0.4, 0.4, 0)})
    outline.push_back(p);
  expect_region(outline, 15, [](const Vec3& p) { return !in_square(p, 1, 1, 1); });
  // Ends that agree within the weld distance only.
  Outline rounded = seamed(square(0, 0, 4), square(1, 1, 1));
  rounded.back() += Vec3(2e-8, -3e-8, 0);
  rounded[4] += Vec3(-2e-8, 1e-8, 0);
  expect_region(rounded, 15, [](const Vec3& p) { return !in_square(p, 1, 1, 1); });
}

TEST(Seams, SeveralHolesNestedHolesAndSeamsFromHoleToHole) {
  const auto without_two = [](const Vec3& p) { return !in_square(p, 1, 1, 1) && !in_square(p, 4, 4, 2); };
  for (const bool first_turned : {false, true})
    for (const bool second_turned : {false, true}) {
      const Outline first = first_turned ? reversed(square(1, 1, 1)) : square(1, 1, 1);
      const Outline second = second_turned ? reversed(square(4, 4, 2)) : square(4, 4, 2);
      expect_region(seamed(seamed(square(0, 0, 8), first), second), 59, without_two);
      expect_region(seamed(square(0, 0, 8), seamed(first, second)), 59, without_two);
      // An island in a hole.
      const Outline island = second_turned ? reversed(square(3, 3, 1)) : square(3, 3, 1);
      const Outline hole = first_turned ? reversed(square(2, 2, 4)) : square(2, 2, 4);
      expect_region(seamed(square(0, 0, 8), seamed(hole, island)), 64 - 16 + 1,
                    [](const Vec3& p) { return !in_square(p, 2, 2, 4) || in_square(p, 3, 3, 1); });
    }
}

TEST(Seams, IslandsThatABridgeJoinsStayIslands) {
  const auto two = [](const Vec3& p) { return in_square(p, 0, 0, 2) || in_square(p, 5, 1, 1); };
  expect_region(seamed(square(0, 0, 2), square(5, 1, 1)), 5, two);
  // The larger one decides which side is the front.
  expect_region(seamed(square(0, 0, 2), reversed(square(5, 1, 1))), 5, two);
  // A hole that was given as one goes to the island that it lies in.
  expect_region(seamed(square(0, 0, 2), square(5, 1, 1)), 4.75,
                [&](const Vec3& p) { return two(p) && !in_square(p, 5.25, 1.25, 0.5); },
                {square(5.25, 1.25, 0.5)});
}

TEST(Seams, EdgeThatLeadsNowhereIsNoEdge) {
  Outline outline = square(0, 0, 2);
  outline.insert(outline.begin() + 1, {{1, 0.5, 0}, {1.5, 1, 0}, {1, 0.5, 0}, {0, 0, 0}});
  expect_region(outline, 4, [](const Vec3&) { return true; });
}

TEST(Seams, BentRingIsSplitIntoTrianglesAndKeepsItsHole) {
  Outline ring = seamed(square(0, 0, 4), square(1, 1, 1));
  ring[2].z() = 0.05;
  TestRoom room;
  const SurfaceId s = room.polygon("bent", room.material(), ring);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.nonplanar_faces, 1U);
  EXPECT_NEAR(meshed_area(r.mesh, s), 15, 0.01);
  for (std::size_t t = 0; t < r.mesh.triangle_count(); ++t)
    EXPECT_FALSE(in_square(r.mesh.point(TriangleId(t), 1.0 / 3, 1.0 / 3), 1, 1, 1));
}

}  // namespace
}  // namespace reemit
