#include "mesh/zones/zone_topology.h"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "tests/mesh/test_room.h"
#include "tests/support/random_splits.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::TestRoom;

Vec3 to_vec(const OpenMesh::Vec3d& v) {
  return {v[0], v[1], v[2]};
}

Vec3 vector_area(const ZoneTopology& topology, ZoneTopology::FaceHandle f) {
  std::vector<Vec3> p;
  for (const auto v : topology.fv_range(f)) p.push_back(to_vec(topology.point(v)));
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += 0.5 * (p[i] - p[0]).cross(p[i + 1] - p[0]);
  return sum;
}

// Every zone is a face of its area, its normal, and around its centroid.
void expect_faces_are_zones(const ZoneMesh& mesh, const ZoneTopology& topology) {
  ASSERT_EQ(topology.n_faces(), mesh.zone_count());
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const auto f = ZoneTopology::FaceHandle(static_cast<int>(z));
    const Vec3 area = vector_area(topology, f);
    ASSERT_NEAR(area.norm(), mesh.zone_area(ZoneId(z)), 1e-9 * mesh.zone_area(ZoneId(z)) + 1e-15);
    ASSERT_GT(area.normalized().dot(mesh.zone_normal(ZoneId(z))), 1 - 1e-9);
    ASSERT_LT((to_vec(topology.normal(f)) - mesh.zone_normal(ZoneId(z))).norm(), 1e-12);
    Vec3 low = Vec3::Constant(1e30);
    Vec3 high = -low;
    for (const auto v : topology.fv_range(f)) {
      low = low.cwiseMin(to_vec(topology.point(v)));
      high = high.cwiseMax(to_vec(topology.point(v)));
    }
    const Vec3 c = mesh.zone_centroid(ZoneId(z));
    ASSERT_TRUE((c.array() >= low.array() - 1e-9).all() && (c.array() <= high.array() + 1e-9).all());
  }
}

ZoneMesh two_triangles(std::uint32_t n, std::uint32_t m, double bend_deg, bool two_sided = false) {
  BaseMesh base;
  const double a = bend_deg * std::numbers::pi / 180;
  base.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -std::cos(a), -std::sin(a)}};
  base.triangles.resize(2);
  base.triangles[0].vertex = {0, 1, 2};
  base.triangles[0].divisions = n;
  base.triangles[1].vertex = {1, 0, 3};
  base.triangles[1].divisions = m;
  for (BaseTriangle& t : base.triangles) {
    t.surface = SurfaceId(0);
    t.two_sided = two_sided;
  }
  return ZoneMesh(base);
}

// Number of halfedge pairs with zones of different base triangles on both sides.
std::size_t shared_edges(const ZoneMesh& mesh, const ZoneTopology& topology) {
  std::size_t count = 0;
  for (const auto e : topology.edges()) {
    if (topology.is_boundary(e)) continue;
    const auto f = topology.face_handle(topology.halfedge_handle(e, 0));
    const auto g = topology.face_handle(topology.halfedge_handle(e, 1));
    const ZoneId a(static_cast<std::size_t>(f.idx()));
    const ZoneId b(static_cast<std::size_t>(g.idx()));
    if (mesh.zone_triangle(a) != mesh.zone_triangle(b)) ++count;
  }
  return count;
}

TEST(ZoneTopology, NeighboursShareEdgesWhateverTheirDivisions) {
  const std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> pieces{
      {{1, 1}, 1}, {{1, 2}, 2}, {{2, 2}, 2}, {{4, 2}, 4},
      {{1, 6}, 6}, {{3, 4}, 6}, {{2, 3}, 4}, {{16, 12}, 24}};
  for (const auto& [n, expected] : pieces) {
    for (const bool two_sided : {false, true}) {
      const ZoneMesh mesh = two_triangles(n.first, n.second, 10, two_sided);
      const ZoneTopology topology = make_zone_topology(mesh, 30);
      expect_faces_are_zones(mesh, topology);
      EXPECT_EQ(shared_edges(mesh, topology), expected * (two_sided ? 2 : 1))
          << n.first << " beside " << n.second;
    }
  }
}

TEST(ZoneTopology, CellsOfSeveralSizesLeaveNoGaps) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const BaseMesh base = two_triangles(1 + seed % 4, 2 + seed % 3, 10, true).base();
    const ZoneMesh mesh(base, {}, test::random_splits(base, 8, seed));
    const ZoneTopology topology = make_zone_topology(mesh, 30);
    expect_faces_are_zones(mesh, topology);
    // A gap or an edge that ends in the middle of another would be a border.
    double border = 0;
    for (const auto e : topology.edges())
      if (topology.is_boundary(e)) border += topology.calc_edge_length(e);
    const double leg = std::sqrt(1.25);
    EXPECT_NEAR(border, 2 * 4 * leg, 1e-9) << "seed " << seed;
  }
}

TEST(ZoneTopology, CreaseSplitsVertices) {
  for (const double bend : {20.0, 40.0}) {
    const ZoneMesh mesh = two_triangles(2, 2, bend);
    const ZoneTopology topology = make_zone_topology(mesh, 30);
    expect_faces_are_zones(mesh, topology);
    EXPECT_EQ(shared_edges(mesh, topology), bend < 30 ? 2U : 0U);
    EXPECT_EQ(topology.n_vertices(), bend < 30 ? 9U : 12U);
  }
}

TEST(ZoneTopology, BackHasItsOwnVerticesAndNormals) {
  const ZoneMesh mesh = two_triangles(2, 2, 0, true);
  const ZoneTopology topology = make_zone_topology(mesh, 30);
  EXPECT_EQ(topology.n_vertices(), 18U);
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    for (const auto v : topology.fv_range(ZoneTopology::FaceHandle(static_cast<int>(z))))
      EXPECT_LT((to_vec(topology.normal(v)) - mesh.zone_normal(ZoneId(z))).norm(), 1e-9);
}

TEST(ZoneTopology, EqualShadingNormalsMakeABendSmooth) {
  BaseMesh base = two_triangles(1, 1, 50).base();
  base.normals = {Vec3(0, -0.4, 1).normalized()};
  for (BaseTriangle& t : base.triangles) t.normal = {0, 0, 0};
  const ZoneMesh mesh(base);
  const ZoneTopology topology = make_zone_topology(mesh, 30);
  EXPECT_EQ(shared_edges(mesh, topology), 1U);
  for (const auto v : topology.vertices())
    EXPECT_LT((to_vec(topology.normal(v)) - base.normals[0]).norm(), 1e-9);
}

TEST(ZoneTopology, SheetsThatMeetInOneEdgeAreKeptApart) {
  BaseMesh base;
  base.vertices = {{0, 0, 0}, {1, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    const double a = 0.2 * i;
    base.vertices.emplace_back(0.5, std::cos(a), std::sin(a));
    BaseTriangle t;
    t.vertex = {0, 1, static_cast<std::uint32_t>(2 + i)};
    t.surface = SurfaceId(0);
    t.divisions = static_cast<std::uint32_t>(1 + i);
    t.two_sided = true;
    base.triangles.push_back(t);
  }
  const ZoneMesh mesh(base);
  const ZoneTopology topology = make_zone_topology(mesh, 30);
  expect_faces_are_zones(mesh, topology);
  EXPECT_EQ(shared_edges(mesh, topology), 0U);
}

TEST(ZoneTopology, SmoothSphereIsClosed) {
  TestRoom room;
  const SurfaceId s = room.surface("sphere", room.material(false));
  constexpr int kRings = 12;
  constexpr int kSlices = 24;
  const auto at = [&](int ring, int slice) -> Vec3 {
    const double theta = std::numbers::pi * ring / kRings;
    const double phi = 2 * std::numbers::pi * (slice % kSlices) / kSlices;
    if (ring == 0) return {0, 0, 1};
    if (ring == kRings) return {0, 0, -1};
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSlices; ++j) {
      if (i > 0) room.add(s, {at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < kRings) room.add(s, {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const MeshResult r = build_mesh(room.scene());
  EXPECT_EQ(r.mesh.triangle_count(), 2U * kSlices * (kRings - 1));
  EXPECT_EQ(test::open_edges(r.mesh), 0U);
  const ZoneTopology topology = make_zone_topology(r.mesh, 30);
  expect_faces_are_zones(r.mesh, topology);
  const auto euler = static_cast<long>(topology.n_vertices()) - static_cast<long>(topology.n_edges()) +
                     static_cast<long>(topology.n_faces());
  EXPECT_EQ(euler, 2);
  for (const auto e : topology.edges()) EXPECT_FALSE(topology.is_boundary(e));
  for (const auto v : topology.vertices()) {
    const Vec3 p = to_vec(topology.point(v));
    ASSERT_GT(to_vec(topology.normal(v)).dot(p.normalized()), 0.98);
  }
}

TEST(ZoneTopology, FurnishedRoomHasEveryZone) {
  TestRoom room;
  room.box("hull", room.material(false), {0, 0, 0}, {4, 4, 3}, true);
  room.box("a", room.material(), {1, 1, 0}, {2, 2, 1});
  room.box("b", room.material(), {1.5, 1.5, 0.5}, {3, 2.5, 2});
  room.polygon("lamp", room.material(false, 3), test::reversed(floor_rectangle(1, 1, 2, 3, 3)));
  const MeshResult r = build_mesh(room.scene());
  const ZoneTopology topology = make_zone_topology(r.mesh, 30);
  expect_faces_are_zones(r.mesh, topology);
  for (const auto v : topology.vertices()) EXPECT_FALSE(topology.is_isolated(v));
}

}  // namespace
}  // namespace reemit
