#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "tests/mesh/test_room.h"

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

// Number of base triangles of a surface that reach to both sides of a line part: `height` is the signed
// distance from the line, `beside` tells whether a point of the line belongs to the part.
std::size_t straddling(const ZoneMesh& mesh, SurfaceId s, const std::function<double(const Vec3&)>& height,
                       const std::function<bool(const Vec3&)>& beside) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (mesh.triangle(t).surface != s) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3& a = mesh.corner(t, k);
      const Vec3& b = mesh.corner(t, (k + 1) % 3);
      const double ha = height(a);
      const double hb = height(b);
      if (ha * hb >= 0 || std::min(std::abs(ha), std::abs(hb)) < 1e-6) continue;
      if (beside(a + ha / (ha - hb) * (b - a))) {
        ++count;
        break;
      }
    }
  }
  return count;
}

TEST(Contact, FloorIsCutUnderAWallThatStandsOnIt) {
  TestRoom room;
  const SurfaceId floor = room.polygon("floor", room.material(), floor_rectangle(0, 0, 6, 4));
  room.polygon("wall", room.material(), {{2.3, 0, 0}, {2.3, 4, 0}, {2.3, 4, 3}, {2.3, 0, 3}});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(straddling(
                r.mesh, floor, [](const Vec3& p) { return p.x() - 2.3; }, [](const Vec3&) { return true; }),
            0U);
  double left = 0;
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i)
    if (r.mesh.triangle(TriangleId(i)).surface == floor && r.mesh.point(TriangleId(i), 0.3, 0.3).x() < 2.3)
      left += r.mesh.triangle_area(TriangleId(i));
  EXPECT_NEAR(left, 2.3 * 4, 24 * kExact);
  EXPECT_EQ(r.report.cut_faces, 1U);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(Contact, FloorThatRunsUnderAPartitionWithADoor) {
  // The wall has a door from y = 1 to 2: its outline dips to the floor on both sides of it.
  TestRoom room;
  const SurfaceId floor = room.polygon("floor", room.material(), floor_rectangle(0, 0, 6, 4));
  room.polygon("wall", room.material(),
               {{3, 0, 0}, {3, 1, 0}, {3, 1, 2}, {3, 2, 2}, {3, 2, 0}, {3, 4, 0}, {3, 4, 3}, {3, 0, 3}});
  MeshSettings coarse;
  coarse.zone_area = 1;
  const MeshResult r = build_mesh(room.scene(), coarse);
  const auto side = [](const Vec3& p) { return p.x() - 3; };
  EXPECT_EQ(straddling(r.mesh, floor, side, [](const Vec3& p) { return p.y() < 0.999 || p.y() > 2.001; }),
            0U);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(Contact, PiercingPanelsAreCutAlongTheirSection) {
  TestRoom room;
  const SurfaceId a = room.polygon("a", room.material(), floor_rectangle(0, 0, 4, 4, 1));
  const SurfaceId b = room.polygon("b", room.material(), {{1, 2, 0}, {3, 2.5, 0}, {3, 2.5, 2}, {1, 2, 2}});
  const MeshResult r = build_mesh(room.scene());
  const Vec3 n = Vec3(-0.5, 2, 0).normalized();
  EXPECT_EQ(straddling(
                r.mesh, a, [&](const Vec3& p) { return n.dot(p - Vec3(1, 2, 1)); },
                [](const Vec3& p) { return p.x() > 1.001 && p.x() < 2.999; }),
            0U);
  EXPECT_EQ(straddling(
                r.mesh, b, [](const Vec3& p) { return p.z() - 1; }, [](const Vec3&) { return true; }),
            0U);
  EXPECT_NEAR(meshed_area(r.mesh, a), 16, 16 * kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_EQ(r.report.cut_faces, 2U);
}

TEST(Contact, PiercedSmoothTriangleKeepsItsShadingNormals) {
  TestRoom room;
  const SurfaceId s = room.surface("curved", room.material());
  Face& f = room.add(s, {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}});
  room.scene().surfaces[s.index()].normals = {Vec3(-0.1, 0, 1).normalized(), Vec3(0.2, 0, 1).normalized(),
                                              Vec3(0, 0.2, 1).normalized()};
  f.normals = {0, 1, 2};
  room.polygon("blade", room.material(), {{0.5, -1, -1}, {0.5, 3, -1}, {0.5, 3, 1}, {0.5, -1, 1}});
  const MeshResult r = build_mesh(room.scene());
  std::size_t pieces = 0;
  for (const BaseTriangle& t : r.mesh.base().triangles) {
    if (t.surface != s) continue;
    ++pieces;
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NE(t.normal[k], BaseTriangle::kFlat);
      const Vec3& p = r.mesh.base().vertices[t.vertex[k]];
      const auto& n = room.scene().surfaces[s.index()].normals;
      const Vec3 wanted =
          ((1 - p.x() / 2 - p.y() / 2) * n[0] + p.x() / 2 * n[1] + p.y() / 2 * n[2]).normalized();
      EXPECT_LT((r.mesh.base().normals[t.normal[k]] - wanted).norm(), 1e-9);
    }
  }
  EXPECT_GT(pieces, 2U);
  EXPECT_NEAR(meshed_area(r.mesh, s), 2, 2 * kExact);
}

TEST(Contact, InterpenetratingBoxes) {
  TestRoom room;
  room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
  const SurfaceId a = room.box("a", room.material(), {1, 1, 1}, {2, 2, 2});
  const SurfaceId b = room.box("b", room.material(), {1.5, 1.5, 1.5}, {3, 3, 3});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_EQ(r.report.cut_faces, 6U);
  EXPECT_NEAR(meshed_area(r.mesh, a), 6, 6 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, b), 13.5, 13.5 * kExact);
  // Buried and free parts are apart: every triangle of b is inside or outside of a as a whole.
  double buried = 0;
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (r.mesh.triangle(t).surface != b) continue;
    const Vec3 c = r.mesh.point(t, 1.0 / 3, 1.0 / 3);
    if (c.maxCoeff() < 2) buried += r.mesh.triangle_area(t);
  }
  EXPECT_NEAR(buried, 3 * 0.25, 1e-6);
}

// A bar with corners at `base` + (0 or `width`) along two directions, and `length` long.
SurfaceId slanted_bar(TestRoom& room, const Vec3& base, const Vec3& along, double width) {
  const Vec3 u = width * along.unitOrthogonal();
  const Vec3 v = width * along.normalized().cross(u).normalized();
  const SurfaceId id = room.surface("bar", room.material());
  const auto p = [&](int i) {
    return Vec3(base + ((i & 1) != 0 ? u : Vec3::Zero()) + ((i & 2) != 0 ? v : Vec3::Zero()) +
                ((i & 4) != 0 ? along : Vec3::Zero()));
  };
  for (const std::array<int, 4>& f : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                      std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
    room.add(id, {p(f[0]), p(f[1]), p(f[2]), p(f[3])});
  return id;
}

TEST(Contact, ThinBarsThroughAWallAreCutHoweverLargeTheZones) {
  for (const double width : {0.2, 0.02, 0.005}) {
    TestRoom room;
    room.box("hull", room.material(false), {0, 0, 0}, {4, 3, 5}, true);
    std::vector<SurfaceId> bars;
    bars.push_back(room.box("straight", room.material(), {1, 0.43, 2}, {1 + width, 0.43 + width, 12}));
    bars.push_back(slanted_bar(room, {3, 2, 3}, {0.4, -0.7, 6}, width));
    bars.push_back(slanted_bar(room, {2, 1.5, 1}, {0.1, 0.4, 5}, width));
    bars.push_back(room.box("plate", room.material(), {0.5, 2.6, 4}, {3.5, 2.6 + 0.1 * width, 7}));
    MeshSettings coarse;
    coarse.zone_area = 1;
    const MeshResult r = build_mesh(room.scene(), coarse);
    for (const SurfaceId bar : bars)
      EXPECT_EQ(straddling(
                    r.mesh, bar, [](const Vec3& p) { return p.z() - 5; }, [](const Vec3&) { return true; }),
                0U)
          << width;
    EXPECT_EQ(r.report.cut_faces, 1U + 4 * 4U) << "the wall and the long faces of the bars";
    EXPECT_LT(worst_book_gap(r), kExact);
  }
}

TEST(Contact, BarThroughTheEdgeOfARoomIsCutAlongBothWalls) {
  TestRoom room;
  room.box("hull", room.material(false), {0, 0, 0}, {4, 3, 5}, true);
  const SurfaceId bar = slanted_bar(room, {3, 1, 4}, {1.7, 0.3, 1.9}, 0.03);
  MeshSettings coarse;
  coarse.zone_area = 1;
  const MeshResult r = build_mesh(room.scene(), coarse);
  const auto within = [](double x, double most) { return x < most - 1e-6; };
  EXPECT_EQ(straddling(
                r.mesh, bar, [](const Vec3& p) { return p.z() - 5; },
                [&](const Vec3& p) { return within(p.x(), 4); }),
            0U);
  EXPECT_EQ(straddling(
                r.mesh, bar, [](const Vec3& p) { return p.x() - 4; },
                [&](const Vec3& p) { return within(p.z(), 5); }),
            0U);
}

TEST(Contact, FloorIsCutAroundAThinLeg) {
  TestRoom room;
  const SurfaceId floor = room.polygon("floor", room.material(), floor_rectangle(0, 0, 6, 4));
  room.box("leg", room.material(), {3, 2, 0}, {3.01, 2.01, 1});
  MeshSettings settings;
  settings.zone_area = 0.04;
  const MeshResult r = build_mesh(room.scene(), settings);
  EXPECT_LT(worst_book_gap(r), kExact);
  EXPECT_NEAR(meshed_area(r.mesh, floor), 24, 24 * kExact);
  double under = 0;
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const Vec3 c = r.mesh.point(t, 1.0 / 3, 1.0 / 3);
    if (r.mesh.triangle(t).surface == floor && (c - Vec3(3.005, 2.005, 0)).cwiseAbs().maxCoeff() < 0.005)
      under += r.mesh.triangle_area(t);
  }
  EXPECT_NEAR(under, 1e-4, 1e-9);
}

TEST(Contact, ManySmallFeaturesDoNotCascade) {
  TestRoom room;
  room.box("hull", room.material(false), {0, 0, 0}, {5, 4, 3}, true);
  const MaterialId m = room.material();
  const SurfaceId board = room.polygon("board", m, floor_rectangle(1, 1, 2.2, 1.3, 1));
  for (int i = 0; i < 30; ++i)  // books, 2 mm apart
    room.box("book" + std::to_string(i), m, {1.02 + i * 0.038, 1.02, 1}, {1.056 + i * 0.038, 1.22, 1.25});
  MeshSettings settings;
  settings.zone_area = 0.005;
  const MeshResult r = build_mesh(room.scene(), settings);
  std::size_t triangles = 0;
  for (const BaseTriangle& t : r.mesh.base().triangles) triangles += t.surface == board ? 1 : 0;
  EXPECT_GT(triangles, 100U) << "cut along every book";
  EXPECT_LT(triangles, 500U);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(Coplanar, BoxOnTheFloor) {
  TestRoom room;
  const SurfaceId hull = room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
  const SurfaceId box = room.box("box", room.material(false), {1, 1, 0}, {2, 2.5, 1});
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.overlapping_faces, 1U);
  EXPECT_NEAR(meshed_area(r.mesh, hull), 96, 96 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, box), 8 - 1.5, 8 * kExact);
  EXPECT_NEAR(r.report.surfaces[box.index()].removed, 1.5, kExact);
  EXPECT_LT(worst_book_gap(r), kExact);
  ASSERT_EQ(r.report.warnings.size(), 1U);
  EXPECT_THAT(r.report.warnings[0], HasSubstr("'hull' covers 1.5 m2 of 'box'"));
  // The floor is cut along the box, so no zone lies half under it.
  const auto under = [](const Vec3& p) { return p.x() > 1 && p.x() < 2 && p.y() > 1 && p.y() < 2.5; };
  double covered = 0;
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (r.mesh.triangle_normal(t).z() > 0.9 && under(r.mesh.point(t, 1.0 / 3, 1.0 / 3)) &&
        r.mesh.corner(t, 0).z() == 0)
      covered += r.mesh.triangle_area(t);
  }
  EXPECT_NEAR(covered, 1.5, kExact);
}

TEST(Coplanar, LampInTheCeilingPlaneWins) {
  for (const bool lamp_first : {false, true}) {
    for (const double offset : {0.0, 1e-7}) {
      TestRoom room;
      const MaterialId white = room.material(false);
      const MaterialId glow = room.material(false, 100);
      const auto panel = reversed(floor_rectangle(1, 1, 2, 1.5, 3 - offset));
      SurfaceId lamp;
      if (lamp_first) lamp = room.polygon("lamp", glow, panel);
      const SurfaceId hull = room.box("hull", white, {0, 0, 0}, {4, 4, 3}, true);
      if (!lamp_first) lamp = room.polygon("lamp", glow, panel);
      const MeshResult r = build_mesh(room.scene());
      EXPECT_NEAR(meshed_area(r.mesh, lamp), 0.5, 0.5 * kExact);
      EXPECT_NEAR(meshed_area(r.mesh, hull), 80 - 0.5, 80 * kExact);
      EXPECT_NEAR(r.report.surfaces[hull.index()].removed, 0.5, 1e-9);
      EXPECT_LT(worst_book_gap(r), kExact);
      EXPECT_EQ(open_edges(r.mesh), 0U) << "the lamp must close the hole it leaves bit by bit";
    }
  }
}

TEST(Coplanar, OverlapOfTwoPanelsGoesToTheFirst) {
  TestRoom room;
  const MaterialId m = room.material();
  const SurfaceId a = room.polygon("a", m, floor_rectangle(0, 0, 2, 2));
  const SurfaceId b = room.polygon("b", m, floor_rectangle(1, 1, 3, 3));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(meshed_area(r.mesh, a), 4, 4 * kExact);
  EXPECT_NEAR(meshed_area(r.mesh, b), 3, 3 * kExact);
  EXPECT_EQ(r.report.overlapping_faces, 1U);
  EXPECT_LT(worst_book_gap(r), kExact);
}

TEST(Coplanar, ClosedLampOnTheFloorDoesNotShineOutOfTheRoom) {
  for (const bool two_sided_floor : {false, true}) {
    TestRoom room;
    const SurfaceId hull = room.box("hull", room.material(two_sided_floor), {0, 0, 0}, {4, 4, 3}, true);
    const SurfaceId lamp = room.box("lamp", room.material(false, 5), {1, 1, 0}, {2, 2, 1});
    const MeshResult r = build_mesh(room.scene());
    EXPECT_NEAR(meshed_area(r.mesh, hull), 80, 80 * kExact);
    EXPECT_NEAR(meshed_area(r.mesh, lamp), 5, 5 * kExact);
  }
}

TEST(Coplanar, PanelLampShinesHoweverTheCeilingIsWound) {
  TestRoom room;
  room.polygon("ceiling", room.material(true), floor_rectangle(0, 0, 4, 4, 3));  // front up
  const SurfaceId lamp =
      room.polygon("lamp", room.material(false, 9), reversed(floor_rectangle(1, 1, 2, 2, 3)));
  room.polygon("floor", room.material(), floor_rectangle(0, 0, 4, 4));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_NEAR(meshed_area(r.mesh, lamp), 1, kExact);
  EXPECT_NEAR(meshed_area(r.mesh, SurfaceId(0)), 15, 15 * kExact);
}

TEST(Coplanar, TouchingPanelsDoNotOverlap) {
  TestRoom room;
  const MaterialId m = room.material();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      room.polygon("tile" + std::to_string(3 * i + j), m,
                   floor_rectangle(i * 0.1, j * 0.3, (i + 1) * 0.1, (j + 1) * 0.3));
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.overlapping_faces, 0U);
  EXPECT_EQ(r.report.cut_faces, 0U);
  EXPECT_EQ(r.mesh.triangle_count(), 18U);
  EXPECT_EQ(r.mesh.base().vertices.size(), 16U);
}

TEST(Orientation, OddFacesOfAShellFollowTheMajority) {
  TestRoom room;
  const SurfaceId s = room.surface("crate", room.material(false));
  auto faces = TestRoom::box_faces({1, 1, 1}, {2, 2, 2});
  std::reverse(faces[3].begin(), faces[3].end());
  for (const auto& f : faces) room.add(s, f);
  room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.flipped_faces, 1U);
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (r.mesh.triangle(t).surface != s) continue;
    EXPECT_GT(r.mesh.triangle_normal(t).dot(r.mesh.corner(t, 0) - Vec3(1.5, 1.5, 1.5)), 0);
  }
  ASSERT_EQ(r.report.warnings.size(), 1U);
  EXPECT_THAT(r.report.warnings[0], HasSubstr("'crate'"));
}

TEST(Orientation, ClosedLampIsTurnedOutwardsButAGlowingRoomIsNot) {
  TestRoom room;
  room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
  const SurfaceId lamp = room.box("lamp", room.material(false, 3), {1, 1, 1}, {2, 2, 2}, true);
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.report.flipped_faces, 6U);
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    if (r.mesh.triangle(t).surface != lamp) continue;
    EXPECT_GT(r.mesh.triangle_normal(t).dot(r.mesh.corner(t, 0) - Vec3(1.5, 1.5, 1.5)), 0);
  }
  TestRoom furnace;
  furnace.box("walls", furnace.material(false, 1), {0, 0, 0}, {4, 4, 4}, true);
  furnace.box("block", furnace.material(), {1, 1, 1}, {2, 2, 2});
  EXPECT_EQ(build_mesh(furnace.scene()).report.flipped_faces, 0U);
}

TEST(Orientation, AGlowingBoothWithARoundSampleIsARoomInTheRoom) {
  const auto flipped = [](const auto& put_in) {
    TestRoom room;
    room.box("lab", room.material(false), {0, 0, 0}, {4, 4, 4}, true);
    room.box("booth", room.material(false, 3), {1, 1, 1}, {2, 2, 2}, true);
    Scene scene = room.scene();
    put_in(scene);
    return build_mesh(scene).report.flipped_faces;
  };
  EXPECT_EQ(flipped([](Scene&) {}), 6U);
  const auto put_ball = [](const Vec3& centre) {
    return [centre](Scene& scene) { scene.surfaces[0].shapes.push_back(Sphere{centre, 0.2}); };
  };
  EXPECT_EQ(flipped(put_ball({1.5, 1.5, 1.5})), 0U);
  EXPECT_EQ(flipped(put_ball({3, 3, 3})), 6U);
  const auto put_eye = [](Scene& scene) { scene.cameras.emplace_back().eye = {1.2, 1.5, 1.5}; };
  EXPECT_EQ(flipped(put_eye), 0U);
}

}  // namespace
}  // namespace reemit
