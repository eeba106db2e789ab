#include "viewer_export/vertex/vertex_radiance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/model/error.h"
#include "solver/gather/direct_light.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "tests/support/crate_room.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::MeanTest;
using test::RoomBuilder;

VertexData gather(const RoomBuilder& room, const Solution& solution, const VertexSettings& settings) {
  const Room walls(room.scene(), solution.mesh);
  const std::atomic<bool> interrupt{false};
  return gather_vertices(walls, solution, settings, {}, interrupt);
}

double area_of(const std::vector<Vec3>& p, const std::array<std::uint32_t, 3>& t) {
  return 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).z();
}

TEST(CutIntoTriangles, uses_every_vertex_and_keeps_the_area_without_slivers) {
  // A right triangle with 0 to 3 further vertices on each side, in every combination.
  const std::array<Vec3, 3> corner{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  for (int code = 0; code < 64; ++code) {
    std::vector<Vec3> polygon;
    for (int side = 0; side < 3; ++side) {
      const int extra = (code >> (2 * side)) & 3;
      for (int i = 0; i <= extra; ++i) {
        const double t = static_cast<double>(i) / (extra + 1);
        polygon.push_back((1 - t) * corner[static_cast<std::size_t>(side)] +
                          t * corner[static_cast<std::size_t>((side + 1) % 3)]);
      }
    }
    const auto triangles = cut_into_triangles(polygon);
    ASSERT_EQ(triangles.size(), polygon.size() - 2);
    double sum = 0;
    for (const auto& t : triangles) {
      EXPECT_GT(area_of(polygon, t), 0.05) << code;
      sum += area_of(polygon, t);
    }
    EXPECT_NEAR(sum, 8, 1e-12);
  }
}

TEST(GatherVertices, opal_sheets_in_a_furnace_are_as_bright_as_its_walls) {
  // rho + tau of the light is sent on from either side of the sheet, and the rest emitted.
  constexpr double kIrradiance = 2;
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0.5 * kIrradiance);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 3);
  const MaterialId opal = room.material("opal", 0.2, 0.3 * kIrradiance, true);
  room.scene().materials[opal.index()].emits_both_sides = true;
  room.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = room.flat(0.5);
  room.quad(opal, {Vec3(0.3, 0.2, 0.5), Vec3(0.7, 0.2, 0.5), Vec3(0.7, 0.8, 0.6), Vec3(0.3, 0.8, 0.6)}, 4);
  const Solution solution = test::uniform_solution(room, 0, kIrradiance);
  for (const bool average_zones : {false, true}) {
    VertexSettings settings;
    settings.average_zones = average_zones;
    const VertexData data = gather(room, solution, settings);
    MeanTest sheet;
    for (std::size_t v = 0; v < data.vertex_count(); ++v)
      if (data.surfaces[v].index() == 6) sheet.add(static_cast<double>(data.radiance[v]));
    ASSERT_EQ(sheet.count(), 50U) << "both sides";
    EXPECT_TRUE(sheet.agrees_with(kIrradiance / pi)) << average_zones;
    EXPECT_TRUE(sheet.would_notice(0.02, kIrradiance / pi)) << average_zones;
  }
}

TEST(GatherVertices, furnace_is_the_same_at_every_vertex) {
  const double m = 3;
  const double rho = 0.5;
  RoomBuilder room;
  const MaterialId wall = room.material("wall", rho, m);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 3);
  const Solution solution = test::uniform_solution(room, m, rho * m / (1 - rho));
  const VertexData data = gather(room, solution, {});
  ASSERT_NO_THROW(check_consistent(data));
  EXPECT_EQ(data.vertex_count(), 6U * 16U);
  EXPECT_EQ(data.triangles.size(), 6U * 18U);
  MeanTest vertices;
  for (const float l : data.radiance) vertices.add(static_cast<double>(l));
  EXPECT_TRUE(vertices.agrees_with(m / pi / (1 - rho)));
  EXPECT_TRUE(vertices.would_notice(0.02, m / pi / (1 - rho)));
  for (std::size_t v = 0; v < data.vertex_count(); ++v)
    EXPECT_NEAR(data.radiance[v], m / pi / (1 - rho), 0.1 * m / pi / (1 - rho)) << v;
}

TEST(GatherVertices, follow_a_point_light_across_a_floor) {
  RoomBuilder room;
  room.quad(room.material("floor", 0.8), {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 8);
  room.scene().lights.push_back(PointLight{"bulb", {0.5, 0.5, 1}, Spectrum::Constant(1, 10.0)});
  const VertexData data = gather(room, test::dark_solution(room), {});
  EXPECT_EQ(data.vertex_count(), 81U);
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const double r2 = (data.positions[v] - Vec3(0.5, 0.5, 1)).squaredNorm();
    const double e = 10 / std::pow(r2, 1.5);
    EXPECT_NEAR(data.irradiance[v], e, 0.02 * e) << data.positions[v].transpose();
    EXPECT_NEAR(data.direct_radiance[v], 0.8 / pi * data.irradiance[v], 1e-4);
    EXPECT_LT(data.normals[v].z() - 1, 1e-12);
  }
}

TEST(GatherVertices, do_not_look_through_a_wall_that_stands_on_the_floor) {
  // Two floors that meet under a wall: one lit, one dark. No vertex mixes them.
  RoomBuilder room;
  const MaterialId floor = room.material("floor", 0.5);
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.quad(floor, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 4);
  room.quad(floor, {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(1, 1, 0)}, 4);
  room.quad(wall, {Vec3(1, -9, 0), Vec3(1, 9, 0), Vec3(1, 9, 9), Vec3(1, -9, 9)}, 1);
  room.scene().lights.push_back(PointLight{"bulb", {0.5, 0.5, 1}, Spectrum::Constant(1, 10.0)});
  const VertexData data = gather(room, test::dark_solution(room), {});
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    if (data.surfaces[v] == SurfaceId(0)) {
      EXPECT_GT(data.irradiance[v], 1);
    } else if (data.surfaces[v] == SurfaceId(1)) {
      EXPECT_EQ(data.irradiance[v], 0);
    }
  }
}

TEST(GatherVertices, unlit_backs_are_left_out_unless_wanted) {
  RoomBuilder room;
  const MaterialId two_sided = room.material("sheet", 0.5, 0, true);
  room.quad(two_sided, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 2);
  Solution solution = test::dark_solution(room);
  VertexSettings settings;
  EXPECT_EQ(gather(room, solution, settings).vertex_count(), 9U);
  settings.all_zones = true;
  EXPECT_EQ(gather(room, solution, settings).vertex_count(), 18U);
  settings.all_zones = false;
  solution.sums.indirect.back() = 1;  // a packet met one zone of the back
  EXPECT_EQ(gather(room, solution, settings).vertex_count(), 18U);
}

TEST(GatherVertices, surfaces_that_are_asked_for_have_the_values_that_they_have_among_all) {
  RoomBuilder room;
  const MaterialId grey = room.material("grey", 0.5);
  const MaterialId lamp = room.material("lamp", 0, 10);
  room.quad(grey, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 4);
  room.quad(lamp, {Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(1, 1, 1), Vec3(1, 0, 1)}, 2);
  const Solution solution = test::dark_solution(room);
  VertexSettings settings;
  settings.only = {SurfaceId(0)};
  const VertexData floor = gather(room, solution, settings);
  EXPECT_EQ(floor.vertex_count(), 25U);
  EXPECT_EQ(floor.triangles.size(), 32U);
  EXPECT_TRUE(std::all_of(floor.surfaces.begin(), floor.surfaces.end(),
                          [](SurfaceId s) { return s == SurfaceId(0); }));
  settings.only = {};
  const VertexData all = gather(room, solution, settings);
  EXPECT_GT(all.vertex_count(), floor.vertex_count());
  int found = 0;
  for (std::size_t v = 0; v < floor.vertex_count(); ++v)
    for (std::size_t w = 0; w < all.vertex_count(); ++w) {
      if (all.surfaces[w] != SurfaceId(0) || all.positions[w] != floor.positions[v]) continue;
      ++found;
      // Other rays; five standard errors of 25 values: once in ten thousand seeds.
      EXPECT_NEAR(floor.radiance[v], all.radiance[w],
                  5 * std::hypot(floor.radiance_stderr[v], all.radiance_stderr[w]));
    }
  EXPECT_EQ(found, 25);
}

/// One surface: a closed block and, apart from it, a table top whose underside is lit. The inside of the
/// block is no side that anyone sees; drawn without culling it would lie black in the block's outside.
TEST(GatherVertices, the_inside_of_a_solid_is_left_out_although_its_surface_has_lit_backs) {
  RoomBuilder room;
  const MaterialId wood = room.material("wood", 0.5, 0, true);
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.box({-2, -2, -2}, {3, 3, 3}, {wall, wall, wall, wall, wall, wall}, 1);
  Surface furniture;
  furniture.name = "furniture";
  furniture.material = wood;
  for (int i = 0; i < 8; ++i) furniture.positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  furniture.faces = {{{0, 4, 6, 2}, {}, {}, 0}, {{1, 3, 7, 5}, {}, {}, 0}, {{0, 1, 5, 4}, {}, {}, 0},
                     {{2, 6, 7, 3}, {}, {}, 0}, {{0, 2, 3, 1}, {}, {}, 0}, {{4, 5, 7, 6}, {}, {}, 0}};
  for (const Vec3& p : {Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(1, 1, 2), Vec3(0, 1, 2)})
    furniture.positions.push_back(p);
  furniture.faces.push_back({{8, 9, 10, 11}, {}, {}, 0});
  room.scene().surfaces.push_back(furniture);
  const SurfaceId id(room.scene().surfaces.size() - 1);
  room.scene().lights.push_back(PointLight{"bulb", Vec3(-1, -1, 1.5), Spectrum::Constant(1, 10.0)});
  SolverSettings solver;
  solver.packets = 20'000;
  const Solution solution = solve(room.scene(), build_mesh(room.scene(), {}), solver, {}, test::kNever);
  VertexSettings settings;
  settings.average_zones = true;
  const VertexData data = gather(room, solution, settings);
  int undersides = 0;
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    if (data.surfaces[v] != id || !data.on_back[v]) continue;
    EXPECT_NEAR(data.positions[v].z(), 2, 1e-9) << "the inside of the block";
    EXPECT_LT(data.normals[v].z(), -0.99);
    ++undersides;
  }
  EXPECT_GE(undersides, 4);
}

TEST(GatherVertices, groups_of_sides_keep_every_vertex) {
  test::CrateRoom room(3, 6);
  MeshSettings mesh_settings;
  mesh_settings.default_zone_count = 400;
  MeshResult grouped = build_zones(room.scene(), mesh_settings);
  MeshResult cells{ZoneMesh(grouped.mesh.base(), {}, grouped.mesh.splits()), grouped.report};
  ASSERT_LT(2 * grouped.mesh.zone_count(), cells.mesh.zone_count());
  VertexSettings settings;
  settings.all_zones = true;
  settings.gather_rays = 64;
  settings.light_samples = 64;
  const auto vertices_of = [&](MeshResult mesh) {
    SolverSettings solver;
    solver.packets = 400'000;
    const Solution solution = solve(room.scene(), std::move(mesh), solver, {}, test::kNever);
    const Room walls(room.scene(), solution.mesh);
    return gather_vertices(walls, solution, settings, {}, test::kNever);
  };
  const VertexData a = vertices_of(std::move(grouped));
  const VertexData b = vertices_of(std::move(cells));
  ASSERT_EQ(a.vertex_count(), b.vertex_count());
  EXPECT_EQ(a.triangles, b.triangles);
  // Light is gathered at the vertex, so means of groups blur only what was reflected twice.
  double difference = 0;
  double square = 0;
  for (std::size_t v = 0; v < a.vertex_count(); ++v) {
    EXPECT_EQ(a.positions[v], b.positions[v]);
    const double d = static_cast<double>(a.irradiance[v]) - static_cast<double>(b.irradiance[v]);
    difference += d * d;
    square += static_cast<double>(b.irradiance[v]) * static_cast<double>(b.irradiance[v]);
  }
  EXPECT_LT(std::sqrt(difference / square), 0.03);
}

TEST(GatherVertices, zone_averages_are_area_weighted_means) {
  RoomBuilder room;
  const MaterialId m = room.material("sheet", 0.5, pi);
  room.quad(m, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 1);
  Solution solution = test::uniform_solution(room, 1, 2);
  solution.sums.direct[1] = 5;
  VertexSettings settings;
  settings.average_zones = true;
  const VertexData data = gather(room, solution, settings);
  ASSERT_EQ(data.vertex_count(), 4U);
  for (std::size_t v = 0; v < 4; ++v) {
    const Vec3& p = data.positions[v];
    const bool on_diagonal = p.x() == p.y();
    const double expected = on_diagonal ? 5 : (p.x() > p.y() ? 3 : 7);
    EXPECT_NEAR(data.irradiance[v], expected, 1e-5);
    EXPECT_NEAR(data.radiance[v], 1 + 0.5 / pi * expected, 1e-5);
    EXPECT_NEAR(data.direct_radiance[v], 0.5 / pi * (expected - 2), 1e-5);
  }
}

TEST(GatherVertices, same_bits_for_any_number_of_threads_and_another_seed_differs) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 4);
  const Solution solution = test::uniform_solution(room, 1, 0.7);
  VertexSettings settings;
  settings.gather_rays = 64;
  settings.light_samples = 16;
  settings.threads = 1;
  const VertexData one = gather(room, solution, settings);
  settings.threads = 2;
  const VertexData two = gather(room, solution, settings);
  EXPECT_EQ(one.radiance, two.radiance);
  EXPECT_EQ(one.radiance_stderr, two.radiance_stderr);
  settings.seed = 2;
  EXPECT_NE(one.radiance, gather(room, solution, settings).radiance);
}

TEST(GatherVertices, standard_errors_shrink_with_rays_and_are_reported) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 1);
  const MaterialId dark = room.material("dark", 0.1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, dark, wall, dark, dark, dark}, 3);
  const Solution solution = test::uniform_solution(room, 1, 0.7);
  VertexSettings settings;
  settings.gather_rays = settings.light_samples = 16;
  const double coarse = gather(room, solution, settings).info.error;
  settings.gather_rays = settings.light_samples = 1024;
  const double fine = gather(room, solution, settings).info.error;
  EXPECT_GT(fine, 0);
  EXPECT_LT(fine, coarse / 6);  // better than the 8 of plain Monte Carlo, with room for luck
}

TEST(GatherVertices, doubles_samples_until_the_error_is_reached) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  const MaterialId lamp = room.material("lamp", 0.2, 1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, lamp, wall}, 3);
  const Solution solution = test::uniform_solution(room, 1, 0.7);
  double last = 1;
  for (const double target : {0.1, 0.02, 0.005}) {
    VertexSettings settings;
    settings.error_target = target;
    const VertexData data = gather(room, solution, settings);
    EXPECT_LE(data.info.error, target);
    EXPECT_LE(data.info.error, last);
    EXPECT_GT(data.info.error, 0);
    EXPECT_FALSE(data.limited_by_zones);
    last = data.info.error;
  }
  EXPECT_LT(last, 0.005);
}

TEST(GatherVertices, an_interrupted_refinement_leaves_no_more_noise_than_the_zones_have) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  const MaterialId lamp = room.material("lamp", 0.2, 1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, lamp, wall}, 3);
  const auto solved = [&](std::uint64_t packets) {
    SolverSettings settings;
    settings.packets = packets;
    return solve(room.scene(), room.mesh(), settings, {}, test::kNever);
  };
  VertexSettings of_zones;
  of_zones.average_zones = true;
  // After the first pass.
  const auto interrupted = [&](const Solution& solution) {
    VertexSettings settings;
    settings.error_target = 1e-3;
    std::atomic<bool> interrupt{false};
    return gather_vertices(
        Room(room.scene(), solution.mesh), solution, settings,
        [&](double done) { interrupt = interrupt || done > 0; }, interrupt);
  };

  const Solution good = solved(1U << 20);
  const VertexData zones = gather(room, good, of_zones);
  const VertexData after_good = interrupted(good);
  EXPECT_FALSE(after_good.gathered);
  EXPECT_EQ(after_good.radiance, zones.radiance);
  EXPECT_EQ(after_good.radiance_stderr, zones.radiance_stderr);
  EXPECT_EQ(after_good.info.error, zones.info.error);

  const Solution poor = solved(1U << 12);
  const VertexData after_poor = interrupted(poor);
  EXPECT_TRUE(after_poor.gathered);
  EXPECT_LT(after_poor.info.error, gather(room, poor, of_zones).info.error);
}

TEST(GatherVertices, refuses_nonsense) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 1);
  const Solution solution = test::uniform_solution(room, 1, 0.7);
  VertexSettings settings;
  settings.reach = 0;
  EXPECT_THROW(gather(room, solution, settings), InputError);
  settings = {};
  settings.average_zones = true;
  settings.error_target = 0.01;
  EXPECT_THROW(gather(room, solution, settings), InputError);
  settings = {};
  settings.gather_rays = 0;
  EXPECT_THROW(gather(room, solution, settings), InputError);
}

/// A flat box without a bottom stands on a floor that is cut along its edges and lit by a point light from
/// one side. The edge that faces the light has vertices of the lit floor and vertices of what it covers,
/// which is dark.
TEST(GatherVertices, lines_of_contact_take_no_darkness_from_under_a_thing) {
  RoomBuilder room;
  const MaterialId floor = room.material("floor", 0.5);
  const MaterialId black = room.material("black", 0, 0, true);
  room.quad(floor, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 1);
  const auto p = [](int i, int j, int k) { return Vec3(0.4 + 0.2 * i, 0.4 + 0.2 * j, 0.05 * k); };
  room.quad(black, {p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)}, 1);
  room.quad(black, {p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)}, 1);
  room.quad(black, {p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)}, 1);
  room.quad(black, {p(1, 1, 0), p(0, 1, 0), p(0, 1, 1), p(1, 1, 1)}, 1);
  room.quad(black, {p(0, 1, 0), p(0, 0, 0), p(0, 0, 1), p(0, 1, 1)}, 1);
  const Vec3 light(1.5, 0.5, 1);
  constexpr double kIntensity = 10;
  room.scene().lights.push_back(PointLight{"bulb", light, Spectrum::Constant(1, kIntensity)});
  MeshSettings mesh;
  mesh.zone_area = 0.002;
  SolverSettings solver;
  solver.packets = 400'000;
  const Solution solution = solve(room.scene(), build_mesh(room.scene(), mesh), solver, {}, test::kNever);

  for (const bool average_zones : {false, true}) {
    VertexSettings settings;
    settings.average_zones = average_zones;
    const VertexData data = gather(room, solution, settings);
    std::set<std::uint32_t> lit;
    std::set<std::uint32_t> covered;
    for (const auto& t : data.triangles) {
      const Vec3 middle = (data.positions[t[0]] + data.positions[t[1]] + data.positions[t[2]]) / 3;
      for (const std::uint32_t v : t) {
        const Vec3& x = data.positions[v];
        if (data.surfaces[v].index() == 0 && std::abs(x.x() - 0.6) < 1e-9 && std::abs(x.y() - 0.5) < 0.08)
          (middle.x() > 0.6 ? lit : covered).insert(v);
      }
    }
    EXPECT_GE(lit.size(), 1U);
    EXPECT_GE(covered.size(), 2U);
    for (const std::uint32_t v : lit) {
      const Vec3 towards = light - data.positions[v];
      const double expected = kIntensity * towards.z() / std::pow(towards.norm(), 3);
      // Zones reach 6 cm outwards, where it is a few per cent brighter, and are noisy.
      EXPECT_NEAR(data.irradiance[v], expected, (average_zones ? 0.25 : 0.03) * expected)
          << data.positions[v].transpose();
    }
    for (const std::uint32_t v : covered) EXPECT_EQ(data.irradiance[v], 0) << data.positions[v].transpose();
  }
}

}  // namespace
}  // namespace reemit
