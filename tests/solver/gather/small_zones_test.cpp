#include "solver/gather/small_zones.h"

#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "tests/support/chi_square.h"
#include "tests/support/never.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::kNever;
using test::VariableFurnace;

/// A furnace with screens whose zones have areas from 2e-4 down to 2e-8 m2; those of the walls have 0.03 m2.
VariableFurnace room_of_many_sizes() {
  VariableFurnace furnace(8);
  double x = 0.2;
  for (const double size : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    furnace.screen({x, 0.2, 0.3}, {size, 0, 0}, {0, 0.4 * size, size}, 5);
    x += 0.25;
  }
  return furnace;
}

Solution run(const VariableFurnace& furnace, bool gather, std::uint64_t seed = 1) {
  SolverSettings settings;
  settings.packets = 5'000'000;
  settings.gather_small_zones = gather;
  settings.seed = seed;
  return solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
}

bool is_small(const Solution& s, std::size_t z) {
  return s.mesh.zone_area(ZoneId(z)) < 3e-4;
}

/// Rms of the relative deviation from the truth over the small zones.
double rms_of_small_zones(const Solution& s) {
  double sum = 0;
  int count = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    if (!is_small(s, z)) continue;
    sum += std::pow(s.irradiance(ZoneId(z), 0).mean / VariableFurnace::kRadiosity - 1, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(SmallZones, are_found_far_better_by_gathering) {
  const VariableFurnace furnace = room_of_many_sizes();
  const Solution before = run(furnace, false);
  const Solution after = run(furnace, true);
  EXPECT_EQ(before.record.gathered_zones, 0U);
  EXPECT_GT(after.record.gathered_zones, 400U);
  EXPECT_EQ(small_zone_count(after.mesh), 500U);
  EXPECT_GT(rms_of_small_zones(before), 0.5);
  EXPECT_LT(rms_of_small_zones(after), 0.1);
}

TEST(SmallZones, keep_all_other_zones) {
  const VariableFurnace furnace = room_of_many_sizes();
  const Solution before = run(furnace, false);
  const Solution after = run(furnace, true);
  for (std::size_t z = 0; z < after.mesh.zone_count(); ++z) {
    if (is_small(after, z)) continue;
    EXPECT_EQ(before.sums.direct[z], after.sums.direct[z]);
    EXPECT_EQ(before.sums.indirect[z], after.sums.indirect[z]);
  }
  EXPECT_EQ(before.sums.batches, after.sums.batches);
  EXPECT_TRUE(after.audit.balanced());
}

/// Irradiances of one small zone of each side of a screen, from many runs. The others of a screen see the
/// same noise of the same walls and would count it again.
std::vector<test::Measured> independent_zones() {
  std::vector<test::Measured> measured;
  const VariableFurnace furnace = room_of_many_sizes();
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Solution s = run(furnace, true, seed);
    std::set<std::pair<SurfaceId, bool>> seen;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      if (!is_small(s, z)) continue;
      if (!seen.emplace(s.mesh.zone_surface(ZoneId(z)), s.mesh.zone_is_front(ZoneId(z))).second) continue;
      const Estimate e = s.irradiance(ZoneId(z), 0);
      measured.push_back({e.mean, e.stderr_of_mean});
    }
  }
  return measured;
}

TEST(SmallZones, have_the_right_mean_and_error) {
  const std::vector<test::Measured> measured = independent_zones();
  // Squared deviations in standard errors as chi-square; a bias of 2 % must be noticed.
  const auto fit = [&](double truth) {
    return test::agreement(measured, std::vector<test::Measured>(measured.size(), {truth, 0}),
                           static_cast<double>(ZoneSums::kGroups));
  };
  EXPECT_GT(fit(VariableFurnace::kRadiosity), test::kFalseAlarm);
  EXPECT_LT(fit(1.02 * VariableFurnace::kRadiosity), test::kFalseAlarm);
}

TEST(SmallZones, need_all_batch_groups) {
  SolverSettings settings;
  settings.packets = 30'000;
  settings.batch_packets = 3'000;
  const VariableFurnace furnace = room_of_many_sizes();
  const Solution s = solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
  EXPECT_EQ(s.record.gathered_zones, 0U);
}

}  // namespace
}  // namespace reemit
