#include "solver/gather/uneven_zones.h"

#include <algorithm>
#include <atomic>

#include <gtest/gtest.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/sampling/sobol.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/lamp_by_ceiling.h"
#include "tests/support/mean_test.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::LampByCeiling;
using test::MeanTest;

std::vector<std::uint8_t> uneven_of(const test::RoomBuilder& room, const Solution& solution,
                                    const StopToken* stop = nullptr) {
  const Room walls(room.scene(), solution.mesh);
  const RadianceField field(walls, solution);
  const DirectLight direct(walls);
  return uneven_zones(field, direct, 1, stop);
}

TEST(UnevenZones, lie_above_a_lamp_close_to_the_ceiling) {
  const LampByCeiling room(0.8);
  const Solution solution = room.solved(400'000, 1);
  const std::vector<std::uint8_t> uneven = uneven_of(room.builder(), solution);
  ASSERT_GT(std::count(uneven.begin(), uneven.end(), 1), 4);
  for (std::size_t z = 0; z < uneven.size(); ++z) {
    if (uneven[z] == 0) continue;
    const Vec3 c = solution.mesh.zone_centroid(ZoneId(z));
    EXPECT_NEAR(c.z(), LampByCeiling::kHeight, 1e-12);
    EXPECT_LT((c - LampByCeiling::middle()).head<2>().cwiseAbs().maxCoeff(),
              LampByCeiling::kLamp / 2 + LampByCeiling::kZone);
  }
}

TEST(UnevenZones, are_those_of_the_room_and_not_of_its_noise) {
  const LampByCeiling room(0.8);
  const std::vector<std::uint8_t> few = uneven_of(room.builder(), room.solved(30'000, 2));
  const std::vector<std::uint8_t> many = uneven_of(room.builder(), room.solved(2'000'000, 3));
  int either = 0;
  int both = 0;
  for (std::size_t z = 0; z < few.size(); ++z) {
    either += few[z] | many[z];
    both += few[z] & many[z];
  }
  EXPECT_GE(both, 0.9 * either);
}

TEST(UnevenZones, are_none_in_a_furnace_or_without_light) {
  const test::VariableFurnace furnace(6);
  const double b = test::VariableFurnace::kRadiosity;
  for (const Solution& solution :
       {test::uniform_solution(furnace.room(), 0.5 * b, 0.5 * b), test::dark_solution(furnace.room())})
    for (const std::uint8_t u : uneven_of(furnace.room(), solution)) EXPECT_EQ(u, 0);
}

TEST(UnevenZones, are_not_looked_for_once_somebody_waits) {
  const LampByCeiling room(0.8);
  const Solution solution = room.solved(400'000, 1);
  const std::atomic<bool> interrupt{true};
  const StopToken stop(interrupt);
  const std::vector<std::uint8_t> uneven = uneven_of(room.builder(), solution, &stop);
  EXPECT_EQ(uneven.size(), solution.mesh.zone_count());
  EXPECT_EQ(std::count(uneven.begin(), uneven.end(), 1), 0);
}

/// Where a ray of a gather starts, and its random numbers.
struct RayStart {
  SurfacePoint x;
  PathKey key;
};

/// Mean reflected radiance over the hemisphere by so many rays, each started as `start_of(number)` says.
template <class StartOf>
double gathered_by(const HemisphereGather& gather, const SobolSequence& sequence, std::uint32_t rays,
                   const StartOf& start_of) {
  GatherBatch batch(gather);
  float sum = 0;
  const float weight = 1.0F / static_cast<float>(rays);
  for (std::uint32_t i = 0; i < rays; ++i) {
    const RayStart start = start_of(i);
    batch.add(start.x, sequence.sample(i, 0), sequence.sample(i, 1), start.key, &weight, &sum);
  }
  batch.flush();
  return static_cast<double>(sum);
}

/// Where packets are so few that most zones have met none in a part, light gathered from all zones is right
/// only if the choice of those that are continued does not ask how many of them a zone has met. Against the
/// same gather that reads every zone, by 32 solutions: 5 standard errors, odds of a false alarm below 1 in
/// 40,000.
TEST(UnevenZones, favour_no_zone_that_has_met_more_packets_than_others) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.6);
  const MaterialId lamp = room.material("lamp", 0.1, 1);
  room.box(Vec3::Zero(), {3, 3, 2.5}, {wall, wall, wall, wall, wall, wall}, 12);
  room.solid({1, 1, 0.01}, {2, 2, 0.8}, wall, 6);
  room.quad(lamp, {Vec3(1, 1, 2.4), Vec3(1, 2, 2.4), Vec3(2, 2, 2.4), Vec3(2, 1, 2.4)}, 2);
  MeanTest difference;
  double mean = 0;
  constexpr int kSolutions = 32;
  for (int seed = 1; seed <= kSolutions; ++seed) {
    SolverSettings settings;
    settings.packets = 2'500;
    settings.seed = static_cast<std::uint64_t>(seed);
    const Solution solution = solve(room.scene(), room.mesh(), settings, {}, test::kNever);
    const Room walls(room.scene(), solution.mesh);
    const RadianceField field(walls, solution, ZoneSums::kGroups);
    const DirectLight direct(walls);
    const HemisphereGather continued(field, direct, {.seed = settings.seed});
    const HemisphereGather read(field, direct, {.continue_uneven = false, .seed = settings.seed});
    const SobolSequence sequence(settings.seed);
    const auto start_of = [&](std::uint32_t i) -> RayStart {
      const auto part = static_cast<std::uint32_t>(i % field.parts());
      return {surface_point(walls.rays(), TriangleId(i % 4), 0.3F, 0.4F, true), {1, part, i, part}};
    };
    constexpr std::uint32_t kRays = 1 << 14;
    const double reading = gathered_by(read, sequence, kRays, start_of);
    difference.add(gathered_by(continued, sequence, kRays, start_of) - reading);
    mean += reading / kSolutions;
  }
  EXPECT_LT(MeanTest::kErrors * difference.standard_error(), 0.01 * mean) << "test too weak";
  EXPECT_NEAR(difference.mean(), 0, MeanTest::kErrors * difference.standard_error() + 0.002 * mean);
}

/// Light that other surfaces send to a point: with uneven zones continued, read everywhere, and path traced.
struct Gathered {
  MeanTest continued, reading, traced;
};

Gathered gather(const Room& walls, const Solution& solution, const SurfacePoint& x) {
  const RadianceField field(walls, solution);
  const DirectLight direct(walls);
  const HemisphereGather continued(field, direct, {});
  const HemisphereGather read(field, direct, GatherSettings{.close_hit = 0});
  const PathTracer path(walls, direct, 1);
  constexpr std::uint32_t kRays = 4096;
  Gathered found;
  for (std::uint32_t r = 0; r < 32; ++r) {
    const SobolSequence sequence(100 + r);
    const auto start_of = [&](std::uint32_t i) -> RayStart { return {x, {1, r, i}}; };
    found.continued.add(gathered_by(continued, sequence, kRays, start_of));
    found.reading.add(gathered_by(read, sequence, kRays, start_of));
    const SobolSequence other(200 + r);
    float sum = 0;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      float weight = 1.0F / kRays;
      path.add_indirect(x, other.sample(i, 0), other.sample(i, 1), {1, r, i}, &weight, &sum);
    }
    found.traced.add(static_cast<double>(sum));
  }
  return found;
}

/// Does continuing agree with path tracing? 5 standard errors: odds of a false alarm below 1 in 40,000; 2 %
/// for the noise of the zones, which all replicates share.
void expect_continued_agrees(const Gathered& found) {
  const double traced = found.traced.mean();
  const double noise =
      MeanTest::kErrors * std::hypot(found.continued.standard_error(), found.traced.standard_error());
  EXPECT_LT(noise, 0.1 * traced) << "test too weak";
  EXPECT_NEAR(found.continued.mean(), traced, noise + 0.02 * traced);
}

/// Only the ceiling reflects, so its zones hold their direct light without a bias, and all the floor gets
/// besides the lamp's own light comes from the parts of the ceiling that the lamp does not hide.
TEST(UnevenZones, floor_gets_what_is_seen_of_the_ceiling_beside_a_lamp) {
  const LampByCeiling room(0);
  const Solution solution = room.solved(4'000'000, 4);
  const Room walls(room.builder().scene(), solution.mesh);
  const SurfacePoint below_the_lamp = surface_point(walls.rays(), room.floor(), 0.3F, 0.4F, true);
  const Gathered found = gather(walls, solution, below_the_lamp);
  expect_continued_agrees(found);
  EXPECT_GT(found.reading.mean(), 1.2 * found.traced.mean()) << "a room without the problem proves nothing";
}

/// A row of the floor's large zones runs on under a cupboard whose front stands on their
/// middle: what the ceiling sees of them is lit, what it does not see is dark.
TEST(UnevenZones, ceiling_gets_what_is_seen_of_the_floor_before_a_cupboard) {
  test::RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  const MaterialId floor = room.material("floor", 0.7);
  const MaterialId wall = room.material("wall", 0.1);
  const MaterialId lamp = room.material("lamp", 0.1, 1);
  room.box(Vec3::Zero(), {4, 4, 2.5}, {wall, wall, wall, wall, floor, wall}, 4);
  room.solid({0.1, 2.5, 0.01}, {3.9, 3.9, 1.5}, black, 2);
  room.quad(lamp, {Vec3(0.2, 0.2, 2.4), Vec3(0.2, 3.8, 2.4), Vec3(3.8, 3.8, 2.4), Vec3(3.8, 0.2, 2.4)}, 2);
  SolverSettings settings;
  settings.packets = 4'000'000;
  const Solution solution = solve(room.scene(), room.mesh(), settings, {}, test::kNever);
  const Room walls(room.scene(), solution.mesh);
  // The front of the lamp, 0.2 m before the cupboard.
  const TriangleId of_lamp(static_cast<std::uint32_t>(solution.mesh.triangle_count()) - 2);
  const SurfacePoint above = surface_point(walls.rays(), of_lamp, 0.1F, 0.5F, true);
  const Gathered found = gather(walls, solution, above);
  expect_continued_agrees(found);
  EXPECT_LT(found.reading.mean(), 0.95 * found.traced.mean()) << "a room without the problem proves nothing";
}

}  // namespace
}  // namespace reemit
