#include "mesh/build_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/mesh/test_room.h"
#include "tests/support/refusal.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::kExact;
using test::meshed_area;
using test::open_edges;
using test::reversed;
using test::TestRoom;
using test::worst_book_gap;
using testing::HasSubstr;

// Closed cube of 4 m whose faces look inwards.
void add_hull(TestRoom& room) {
  room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
}

TEST(BuildMesh, EmptyRoomOfRectanglesStaysTwelveTriangles) {
  TestRoom room;
  add_hull(room);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.mesh.triangle_count(), 12U);
  EXPECT_EQ(r.mesh.base().vertices.size(), 8U);
  EXPECT_EQ(open_edges(r.mesh), 0U);
  EXPECT_NEAR(r.report.surfaces[0].meshed, 96, 96 * kExact);
  EXPECT_EQ(r.report.surfaces[0].removed, 0);
  EXPECT_TRUE(r.report.warnings.empty());
  EXPECT_LT(worst_book_gap(r), kExact);
  for (std::size_t i = 0; i < 12; ++i) {
    const TriangleId t(i);
    const Vec3 to_centre = Vec3(2, 2, 2) - r.mesh.corner(t, 0);
    EXPECT_GT(r.mesh.triangle_normal(t).dot(to_centre), 0) << "fronts must look inwards as given";
  }
}

TEST(BuildMesh, WhatWeldingMovesIsNotRemoved) {
  // The second floor meets the first but for less than the weld distance, and so grows or shrinks by it.
  for (const double gap : {1e-7, -1e-7}) {
    TestRoom room;
    room.polygon("first", room.material(), floor_rectangle(0, 0, 4, 4));
    room.polygon("second", room.material(), floor_rectangle(4 + gap, 0, 8, 4));
    const MeshResult r = build_mesh(room.scene());
    EXPECT_EQ(r.report.surfaces[0].removed, 0);
    EXPECT_EQ(r.report.surfaces[1].removed, 0);
    EXPECT_NEAR(r.report.surfaces[1].welded, -4 * gap, 1e-9);
    EXPECT_LT(worst_book_gap(r), kExact);
  }
}

TEST(BuildMesh, ZonesRespectTheWantedArea) {
  TestRoom room;
  add_hull(room);
  MeshSettings settings;
  settings.zone_area = 0.05;
  const MeshResult r = build_mesh(room.scene(), settings);
  for (std::size_t z = 0; z < r.mesh.zone_count(); ++z)
    ASSERT_LE(r.mesh.zone_area(ZoneId(z)), 0.05 * (1 + 1e-9));
  settings.zone_area = 1e-12;
  EXPECT_THROW(build_mesh(room.scene(), settings), InputError);
  settings.zone_area = -1;
  EXPECT_THROW(build_mesh(room.scene(), settings), InputError);
}

TEST(BuildMesh, DoesNotDependOnScaleOrPlace) {
  std::size_t triangles = 0;
  for (const double scale : {1.0, 1e-3, 1e6}) {
    for (const double shift : {0.0, 1e4}) {
      TestRoom room;
      const Vec3 o = scale * shift * Vec3(4, 4, 4);
      room.box("hull", room.material(false), o, o + scale * Vec3(4, 4, 4), true);
      room.box("block", room.material(), o + scale * Vec3(1, 1, 0), o + scale * Vec3(2, 2.5, 1));
      room.polygon("screen", room.material(),
                   {o + scale * Vec3(3, 0.5, 0), o + scale * Vec3(3, 3, 0), o + scale * Vec3(3, 3, 2)});
      const MeshResult r = build_mesh(room.scene());
      EXPECT_LT(worst_book_gap(r), kExact);
      // Corners of rectangles lie on one circle; which diagonal they get hangs on the last digit.
      if (triangles == 0) triangles = r.mesh.triangle_count();
      EXPECT_NEAR(static_cast<double>(r.mesh.triangle_count()), static_cast<double>(triangles), 5.0)
          << "scale " << scale << ", shift " << shift;
      EXPECT_EQ(r.report.overlapping_faces, 1U);
    }
  }
}

TEST(BuildMesh, HolesOfAnyWindingAreCutOut) {
  for (const bool turned : {false, true}) {
    TestRoom room;
    const SurfaceId s = room.polygon("wall", room.material(), floor_rectangle(0, 0, 4, 3));
    const auto window = floor_rectangle(1, 1, 2, 2);
    room.add_hole(s, turned ? reversed(window) : window);
    room.add_hole(s, floor_rectangle(2.5, 1, 3.5, 2));
    const MeshResult r = build_mesh(room.scene());
    EXPECT_NEAR(r.report.surfaces[0].input, 10, 10 * kExact);
    EXPECT_NEAR(meshed_area(r.mesh, s), 10, 10 * kExact);
    for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
      const Vec3 c = r.mesh.point(TriangleId(i), 1.0 / 3, 1.0 / 3);
      EXPECT_FALSE(c.x() > 1 && c.x() < 2 && c.y() > 1 && c.y() < 2);
      EXPECT_GT(r.mesh.triangle_normal(TriangleId(i)).z(), 0.999);
    }
  }
}

TEST(BuildMesh, SeamOfAnMgfHoleIsNoEdge) {
  TestRoom room;
  const SurfaceId s = room.polygon("wall", room.material(),
                                   {{0, 0, 0},
                                    {4, 0, 0},
                                    {4, 3, 0},
                                    {0, 3, 0},
                                    {0, 0, 0},
                                    {1, 1, 0},
                                    {1, 2, 0},
                                    {2, 2, 0},
                                    {2, 1, 0},
                                    {1, 1, 0}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(r.report.surfaces[0].input, 11, 11 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, s), 11, 11 * kExact);
  EXPECT_TRUE(r.report.warnings.empty());
}

TEST(BuildMesh, BentQuadBecomesTriangles) {
  TestRoom room;
  // The left wall of the Cornell box: 3.2 mm off in 560.
  const SurfaceId s = room.polygon("left", room.material(),
                                   {{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.nonplanar_faces, 1U);
  EXPECT_LT(worst_book_gap(r), kExact);
  for (const Vec3& p : room.scene().surfaces[s.index()].positions)
    EXPECT_THAT(r.mesh.base().vertices, testing::Contains(p)) << "corners must not be moved";
  ASSERT_EQ(r.report.warnings.size(), 1U);
  EXPECT_THAT(r.report.warnings[0], HasSubstr("'left' (test-room:1, face 0)"));
}

TEST(BuildMesh, RoundedCoordinatesAreNotCalledBent) {
  TestRoom room;
  room.polygon("tilted", room.material(),
               {{0, 0, 0}, {0.866025, 0, 0.5}, {0.866025, 1, 0.500001}, {0, 1, 0}, {-0.1, 0.5, -0.057735}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.nonplanar_faces, 0U);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(BuildMesh, TJunctionIsClosed) {
  TestRoom room;
  const MaterialId m = room.material();
  room.polygon("left", m, floor_rectangle(0, 0, 2, 3));
  room.polygon("right low", m, floor_rectangle(2, 0, 4, 1));
  room.polygon("right high", m, floor_rectangle(2, 1, 4, 3));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_NEAR(meshed_area(r.mesh, SurfaceId(0)), 6, 6 * kExact);
  // Only the outline of the whole, 4 corners and 2 ends of common edges on it and what refinement added, is
  // open.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const BaseTriangle& t : r.mesh.base().triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax({t.vertex[k], t.vertex[(k + 1) % 3]}));
  for (const auto& e : edges) {
    const Vec3 middle = 0.5 * (r.mesh.base().vertices[e.first] + r.mesh.base().vertices[e.second]);
    const bool on_outline = middle.x() == 0 || middle.x() == 4 || middle.y() == 0 || middle.y() == 3;
    EXPECT_EQ(std::count(edges.begin(), edges.end(), e), on_outline ? 1 : 2) << middle.transpose();
  }
}

TEST(BuildMesh, DuplicatesAreDroppedAndTheLuminaireKept) {
  TestRoom room;
  const auto spot = floor_rectangle(0, 0, 1, 1);
  const SurfaceId plain = room.polygon("plain", room.material(), spot);
  const SurfaceId lamp = room.polygon("lamp", room.material(false, 10), {spot[2], spot[3], spot[0], spot[1]});
  const SurfaceId back = room.polygon("back", room.material(), reversed(spot));
  room.polygon("floor", room.material(), floor_rectangle(3, 3, 5, 5));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.duplicate_faces, 2U);
  EXPECT_EQ(meshed_area(r.mesh, plain), 0);
  EXPECT_NEAR(meshed_area(r.mesh, lamp), 1, kExact);
  EXPECT_NEAR(r.report.surfaces[back.index()].removed, 1, kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_EQ(r.report.warnings.size(), 1U);
}

TEST(BuildMesh, SheetOfTwoOpposedFacesBecomesTwoSided) {
  TestRoom room;
  const SurfaceId s = room.surface("sheet", room.material(false));
  room.add(s, floor_rectangle(0, 0, 1, 1));
  room.add(s, reversed(floor_rectangle(0, 0, 1, 1)));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(meshed_area(r.mesh, s), 1, kExact);
  for (const BaseTriangle& t : r.mesh.base().triangles) EXPECT_TRUE(t.two_sided);
}

TEST(BuildMesh, DegenerateFacesAreCountedAndBooked) {
  TestRoom room;
  const SurfaceId s = room.surface("mixed", room.material());
  room.add(s, floor_rectangle(0, 0, 1, 1));
  room.add(s, {{0, 0, 0}, {1, 1, 0}, {0.5, 0.5, 0}});
  room.add(s, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}});
  room.add(s, {{2, 0, 0}, {2, 0, 0}, {2, 0, 0}});
  room.add(s, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.degenerate_faces, 3U);
  EXPECT_EQ(r.report.overlapping_faces, 1U);
  EXPECT_NEAR(meshed_area(r.mesh, s), 1, kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(BuildMesh, NeedlesDoNotExplode) {
  TestRoom room;
  const SurfaceId s = room.surface("strips", room.material());
  room.add(s, floor_rectangle(0, 0, 10, 1e-3));
  room.add(s, floor_rectangle(0, 1, 10, 5));
  room.add(s, {{0, 6, 0}, {10, 6, 0}, {10, 6.00001, 0}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_LT(r.mesh.triangle_count(), 2000U);
  EXPECT_NEAR(meshed_area(r.mesh, s), 0.01 + 40 + 5e-5, 40 * kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(BuildMesh, OutlineThatCrossesItself) {
  TestRoom eight;  // equal lobes: each faces as it winds
  const SurfaceId e = eight.polygon("eight", eight.material(), {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}});
  eight.polygon("floor", eight.material(), floor_rectangle(2, 2, 3, 3));
  const MeshResult halves = build_mesh(eight.scene());
  EXPECT_NEAR(meshed_area(halves.mesh, e), 0.5, kExact);
  EXPECT_LT(worst_book_gap(halves), kExact);
  EXPECT_THAT(halves.report.warnings, ElementsAre(HasSubstr("'eight' (test-room:1, face 0)")));
  double right = 0;  // area by the height of normals
  double left = 0;
  for (std::size_t t = 0; t < halves.mesh.triangle_count(); ++t) {
    const TriangleId id(t);
    if (halves.mesh.surface(id, true) != e) continue;
    double middle = 0;
    for (const std::uint32_t v : halves.mesh.triangle(id).vertex)
      middle += halves.mesh.base().vertices[v].x() / 3;
    (middle > 0.5 ? right : left) += halves.mesh.triangle_area(id) * halves.mesh.triangle_normal(id).z();
  }
  EXPECT_NEAR(right, -0.25, kExact);
  EXPECT_NEAR(left, 0.25, kExact);
  TestRoom room;  // one lobe is larger: filled, with a warning
  const SurfaceId s = room.polygon("bow", room.material(), {{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 1, 0}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(meshed_area(r.mesh, s), 0.375 + 3.375, 4 * kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_EQ(r.report.warnings.size(), 1U);
}

TEST(BuildMesh, BadInputIsRefusedWithTheFaceNamed) {
  TestRoom room;
  EXPECT_THROW(build_mesh(room.scene()), InputError);
  const SurfaceId s = room.polygon("wall", room.material(), floor_rectangle(0, 0, 1, 1));
  room.scene().surfaces[s.index()].faces[0].outer[2] = 99;
  EXPECT_THROW(build_mesh(room.scene()), InputError);
  TestRoom nan;
  nan.polygon("wall", nan.material(),
              {{0, 0, 0}, {1, 0, 0}, {1, std::numeric_limits<double>::quiet_NaN(), 0}});
  EXPECT_THROW(build_mesh(nan.scene()), InputError);
}

TEST(BuildMesh, SameRoomGivesTheSameMesh) {
  const auto build = [] {
    TestRoom room;
    add_hull(room);
    room.box("a", room.material(), {1, 1, 0}, {2, 2, 1});
    room.box("b", room.material(), {1.5, 1.5, 0.5}, {3, 2.5, 2});
    return build_mesh(room.scene());
  };
  const MeshResult a = build();
  const MeshResult b = build();
  ASSERT_EQ(a.mesh.triangle_count(), b.mesh.triangle_count());
  for (std::size_t i = 0; i < a.mesh.triangle_count(); ++i)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(a.mesh.corner(TriangleId(i), k), b.mesh.corner(TriangleId(i), k));
}

}  // namespace
}  // namespace reemit
