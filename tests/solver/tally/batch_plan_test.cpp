#include "solver/tally/batch_plan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/solution/solution.h"

namespace reemit {
namespace {

constexpr std::int64_t kRound = static_cast<std::int64_t>(ZoneSums::kGroups);

TEST(BatchPlan, SmallRoomsHaveEqualBatches) {
  const BatchPlan plan({}, 4096);
  EXPECT_EQ(plan.unit_packets(), 65'536U);
  for (std::int64_t k = 0; k < 1000; ++k) ASSERT_EQ(plan.next_weight(k, k), 1);
}

TEST(BatchPlan, LargeRoomsStartSmallAndGrow) {
  const BatchPlan plan({}, 1'000'000);
  EXPECT_EQ(plan.unit_packets(), 250'000U);
  std::int64_t done = 0;
  std::int64_t last = 0;
  std::int64_t batches = 0;
  for (; last * 250'000 < 16'000'000; ++batches) {
    ASSERT_LT(batches, 1000);
    const std::int64_t weight = plan.next_weight(batches, done);
    if (batches % kRound == 0) {
      EXPECT_GE(weight, last);
    } else {
      EXPECT_EQ(weight, last) << "groups would differ after batch " << batches;
    }
    if (batches >= kRound) {
      EXPECT_LE(weight * kRound, done) << "a cut-off batch would cost too much";
    }
    last = weight;
    done += weight;
  }
  EXPECT_EQ(plan.next_weight(batches + 5000, done), last) << "full size";
  EXPECT_EQ(plan.largest_batch_packets(), static_cast<std::uint64_t>(last) * 250'000);
}

TEST(BatchPlan, PacketsAreSpentInWholeBatches) {
  for (const std::uint64_t packets :
       {1ULL, 2ULL, 1000ULL, 100'000ULL, 1'000'000ULL, 123'456'789ULL, 1'000'000'000'000ULL})
    for (const std::size_t zones : {100U, 100'000U}) {
      SolverSettings s;
      s.packets = packets;
      const BatchPlan plan(s, zones);
      std::int64_t done = 0;
      std::int64_t batches = 0;
      while (const std::int64_t weight = plan.next_weight(batches, done)) {
        done += weight;
        ++batches;
      }
      EXPECT_EQ(done, plan.weight_of_packets());
      const std::uint64_t spent = static_cast<std::uint64_t>(done) * plan.unit_packets();
      EXPECT_LE(spent, packets);
      EXPECT_GE(static_cast<double>(spent), 0.999 * static_cast<double>(packets));
      EXPECT_GE(batches, std::min<std::int64_t>(static_cast<std::int64_t>(packets), 2));
      if (packets >= 16'384) {
        EXPECT_GE(batches, 16);
      }
    }
}

TEST(BatchPlan, FewPacketsMakeFewBatchesInsteadOfTinyOnes) {
  SolverSettings s;
  for (const std::uint64_t packets : {256U, 1000U, 4000U, 16'000U}) {
    s.packets = packets;
    const BatchPlan plan(s, 100);
    EXPECT_GE(plan.unit_packets(), 64 * plan.weight_of_packets()) << packets;
  }
}

TEST(BatchPlan, BatchesOfAGivenSizeAreLeftAlone) {
  SolverSettings s;
  s.packets = 1000;
  s.batch_packets = 10;
  const BatchPlan plan(s, 1'000'000);
  EXPECT_EQ(plan.unit_packets(), 10U);
  EXPECT_EQ(plan.weight_of_packets(), 100);
  EXPECT_EQ(plan.next_weight(99, 99), 1);
  EXPECT_EQ(plan.next_weight(100, 100), 0);
}

TEST(BatchPlan, StopsWhereTheBooksAreFull) {
  const BatchPlan plan({}, 1'000'000);
  const std::int64_t most = std::int64_t{1} << 21;  // times 2^42 quanta is 2^63
  EXPECT_EQ(plan.next_weight(20'000, most - 1), 0);
  EXPECT_EQ(plan.next_weight(20'000, most - 4), 3);
}

}  // namespace
}  // namespace reemit
