#pragma once
#include <cstddef>
#include <tuple>

#include <gtest/gtest.h>

#include "solver/solution/solution.h"

namespace reemit::test {

/// Two runs that must be the same bit for bit: sums, what was gathered, books and counts.
inline void expect_same_light(const Solution& a, const Solution& b) {
  EXPECT_EQ(a.sums.batches, b.sums.batches);
  EXPECT_EQ(a.sums.group_weight, b.sums.group_weight);
  EXPECT_EQ(a.sums.weight_squared, b.sums.weight_squared);
  ASSERT_EQ(a.sums.columns().size(), b.sums.columns().size());
  for (std::size_t c = 0; c < a.sums.columns().size(); ++c)
    EXPECT_EQ(*a.sums.columns()[c], *b.sums.columns()[c]) << "column " << c;
  EXPECT_EQ(a.sums.group_total, b.sums.group_total);
  EXPECT_EQ(a.gathered.zones, b.gathered.zones);
  EXPECT_EQ(a.gathered.sums, b.gathered.sums);
  EXPECT_EQ(a.gathered.group_total, b.gathered.group_total);
  EXPECT_EQ(a.gathered.rays, b.gathered.rays);
  EXPECT_EQ(a.audit.batches, b.audit.batches);
  EXPECT_EQ(a.audit.weight, b.audit.weight);
  EXPECT_EQ(a.audit.events.second_looks, b.audit.events.second_looks);
  EXPECT_EQ(a.audit.events.back_hits, b.audit.events.back_hits);
  EXPECT_EQ(a.audit.events.escapes, b.audit.events.escapes);
  EXPECT_EQ(a.audit.events.starts_behind, b.audit.events.starts_behind);
  EXPECT_EQ(a.audit.events.roulette_jumps, b.audit.events.roulette_jumps);
  ASSERT_EQ(a.audit.bands.size(), b.audit.bands.size());
  for (std::size_t i = 0; i < a.audit.bands.size(); ++i) {
    const BandAudit& x = a.audit.bands[i];
    const BandAudit& y = b.audit.bands[i];
    EXPECT_EQ(std::tie(x.band, x.watts_per_quantum, x.emitted, x.absorbed, x.absorbed_on_backs, x.escaped,
                       x.unshot, x.roulette_net, x.roulette_gain),
              std::tie(y.band, y.watts_per_quantum, y.emitted, y.absorbed, y.absorbed_on_backs, y.escaped,
                       y.unshot, y.roulette_net, y.roulette_gain));
  }
}

/// The same of two records of runs, but for what depends on clock and threads.
inline void expect_same_record(const SolveRecord& a, const SolveRecord& b) {
  EXPECT_EQ(a.stopped, b.stopped);
  EXPECT_EQ(a.packets, b.packets);
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.error_bound, b.error_bound);
  EXPECT_EQ(a.gathered_zones, b.gathered_zones);
  EXPECT_EQ(a.discretisation, b.discretisation);
}

/// What stills of the two would begin with.
inline void expect_same_plan(const GatherPlan& a, const GatherPlan& b) {
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.uneven, b.uneven);
  ASSERT_EQ(a.caustics.has_value(), b.caustics.has_value());
  if (!a.caustics) return;
  EXPECT_EQ(a.caustics->packets, b.caustics->packets);
  EXPECT_EQ(a.caustics->brings, b.caustics->brings);
  EXPECT_EQ(a.caustics->radius_codes, b.caustics->radius_codes);
}

}  // namespace reemit::test
