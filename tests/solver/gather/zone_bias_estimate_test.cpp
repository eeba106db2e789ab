#include "solver/gather/zone_bias_estimate.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/lamp_by_ceiling.h"
#include "tests/support/never.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

/// The estimate for a furnace whose zones are off by a factor: every gather ray reads them, and path tracing
/// finds the truth.
ZoneBias estimate_of(double factor) {
  constexpr double kRho = 0.5;
  constexpr double kExitance = 2;
  constexpr double kIrradianceOfWalls = kExitance / (1 - kRho);
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", kRho, kExitance);
  room.box({0, 0, 0}, {1, 2, 3}, {wall, wall, wall, wall, wall, wall}, 4);
  const Solution solution = test::uniform_solution(room, 0, factor * kIrradianceOfWalls);
  const Room walls(room.scene(), solution.mesh);
  const RadianceField field(walls, solution);
  const DirectLight direct(walls);
  const HemisphereGather gather(field, direct, GatherSettings{.close_hit = 0});
  const PathTracer path(walls, direct, 1);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < ZoneBiasEffort::kPoints; ++i)
    points.push_back(
        surface_point(walls.rays(), TriangleId(i % walls.rays().mesh().triangle_count()), 0.3F, 0.3F, true));
  // Over the radiance rho^2 E/pi that is there after at least two reflections.
  const std::vector<double> scale(points.size(), std::numbers::pi / (kRho * kRho * kIrradianceOfWalls));
  return estimate_zone_bias(gather, path, points, scale, {256}, 1).value();
}

TEST(ZoneBiasEstimate, finds_a_planted_bias_and_nothing_without) {
  // The bound is 2 standard errors of the square above the estimate; five of them are allowed.
  for (const double bias : {0.1, -0.1}) {
    const ZoneBias found = estimate_of(1 + bias);
    EXPECT_TRUE(found.certain());
    EXPECT_NEAR(found.rms, 0.1, 2.5 * (found.bound - found.rms));
    EXPECT_LT(found.bound - found.rms, 0.015) << "test too weak";
  }
  const ZoneBias none = estimate_of(1);
  EXPECT_FALSE(none.certain());
  EXPECT_LT(none.bound, 0.03);
}

TEST(ZoneBiasEstimate, solve_states_next_to_nothing_in_a_furnace) {
  const test::VariableFurnace furnace(8);
  SolverSettings settings;
  settings.packets = 2'000'000;
  const Solution solution = solve(furnace.room().scene(), furnace.room().mesh(), settings, {}, test::kNever);
  ASSERT_TRUE(solution.record.gather_bias.has_value());
  EXPECT_FALSE(solution.record.gather_bias->certain());
  EXPECT_LT(solution.record.gather_bias->bound, 0.04);
}

/// Zones four times the gap between lamp and ceiling send light out of the gap that it holds, where they send
/// it on evenly.
TEST(ZoneBiasEstimate, solve_states_that_zones_are_too_large_beside_a_lamp) {
  const test::LampByCeiling room(0.8);
  const Solution zonal = room.solved(4'000'000, 1, Reemission::kFromZones);
  ASSERT_TRUE(zonal.record.gather_bias.has_value());
  EXPECT_TRUE(zonal.record.gather_bias->certain());
  EXPECT_GT(zonal.record.gather_bias->rms, 0.02);
  EXPECT_LT(zonal.record.gather_bias->rms, 0.3);
  const Solution solution = room.solved(4'000'000, 1);
  ASSERT_TRUE(solution.record.gather_bias.has_value());
  EXPECT_LT(solution.record.gather_bias->rms, zonal.record.gather_bias->rms / 2);
}

// No path that leaves a surface meets a point: what a mirror throws of its light would look like a bias.
TEST(ZoneBiasEstimate, says_nothing_where_mirrors_throw_light_that_paths_do_not_find) {
  for (const bool has_lamp_without_area : {false, true}) {
    test::RoomBuilder room;
    const MaterialId wall = room.material("wall", 0.5);
    const MaterialId mirror = room.material("mirror", 0);
    const MaterialId lamp = room.material("lamp", 0, 100);
    room.scene().materials[mirror.index()].non_diffuse.specular_reflectance = room.flat(0.9);
    room.box({0, 0, 0}, {1, 1, 1}, {mirror, wall, wall, wall, wall, wall}, 6);
    room.quad(lamp, {Vec3(.4, .4, .99), Vec3(.4, .6, .99), Vec3(.6, .6, .99), Vec3(.6, .4, .99)}, 1);
    if (has_lamp_without_area)
      room.scene().lights.push_back(
          SpotLight{"spot", {0.8, 0.5, 0.5}, Vec3(-1, 0, 0), room.flat(10), 0.2, 0.3});
    SolverSettings settings;
    settings.packets = 200'000;
    const Solution solution = solve(room.scene(), room.mesh(), settings, {}, test::kNever);
    EXPECT_EQ(solution.record.gather_bias.has_value(), !has_lamp_without_area);
    EXPECT_TRUE(!has_lamp_without_area || !solution.record.discretisation);
  }
}

}  // namespace
}  // namespace reemit
