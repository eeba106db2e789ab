#include "solver/gather/uneven_zones.h"

#include <algorithm>
#include <atomic>

#include <gtest/gtest.h>

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

/// Only the ceiling reflects, so its zones hold their direct light without a bias, and all the floor gets
/// besides the lamp's own light comes from the parts of the ceiling that the lamp does not hide.
TEST(UnevenZones, floor_gets_what_is_seen_of_the_ceiling_beside_a_lamp) {
  const LampByCeiling room(0);
  const Solution solution = room.solved(4'000'000, 4);
  const Room walls(room.builder().scene(), solution.mesh);
  const RadianceField field(walls, solution);
  const DirectLight direct(walls);
  const HemisphereGather continued(field, direct, {});
  const HemisphereGather read(field, direct, GatherSettings{.close_hit = 0});
  const PathTracer path(walls, direct, 1);
  // A point of the floor below the lamp.
  const SurfacePoint x = surface_point(walls.rays(), room.floor(), 0.3F, 0.4F, true);
  MeanTest by_continued;
  MeanTest by_reading;
  MeanTest traced;
  constexpr std::uint32_t kRays = 4096;
  for (std::uint32_t r = 0; r < 32; ++r) {
    const SobolSequence sequence(100 + r);
    const auto gathered = [&](const HemisphereGather& gather) {
      GatherBatch batch(gather);
      float sum = 0;
      const float weight = 1.0F / kRays;
      for (std::uint32_t i = 0; i < kRays; ++i)
        batch.add(x, sequence.sample(i, 0), sequence.sample(i, 1), {1, r, i}, &weight, &sum);
      batch.flush();
      return static_cast<double>(sum);
    };
    by_continued.add(gathered(continued));
    by_reading.add(gathered(read));
    const SobolSequence other(200 + r);
    float sum = 0;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      float weight = 1.0F / kRays;
      path.add_indirect(x, other.sample(i, 0), other.sample(i, 1), {1, r, i}, &weight, &sum);
    }
    traced.add(static_cast<double>(sum));
  }
  // 5 standard errors: odds of a false alarm below 1 in 40,000; 2 % for the noise of the zones, which all
  // replicates share.
  const double noise = MeanTest::kErrors * std::hypot(by_continued.standard_error(), traced.standard_error());
  EXPECT_LT(noise, 0.1 * traced.mean()) << "test too weak";
  EXPECT_NEAR(by_continued.mean(), traced.mean(), noise + 0.02 * traced.mean());
  EXPECT_GT(by_reading.mean(), 1.2 * traced.mean()) << "a room without the problem proves nothing";
}

}  // namespace
}  // namespace reemit
