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

// What an error of 0.01 % takes: some 10^8 packets for every zone.
TEST(BatchPlan, RunsOfAnyLengthGoOnInFewBatches) {
  for (const std::size_t zones : {100U, 10'000U, 100'000U, 10'000'000U}) {
    const BatchPlan plan({}, zones);
    const double unit = plan.unit_packets();
    std::int64_t done = 0;
    std::int64_t batches = 0;
    std::int64_t last = 0;
    for (; static_cast<double>(done) * unit < 1e13; batches += kRound) {
      const std::int64_t weight = plan.next_weight(batches, done);
      ASSERT_GE(weight, std::max<std::int64_t>(last, 1));
      if (batches >= 50'000 && weight < (1 << 24) / static_cast<std::int64_t>(plan.unit_packets())) {
        EXPECT_GE(static_cast<double>(weight), static_cast<double>(done) / (1 << 14) - 1)
            << "too small beside the sums";
      }
      const std::int64_t planned = std::max<std::int64_t>(done / kRound, 1);
      EXPECT_LE(weight, planned) << "a cut-off batch would cost too much";
      EXPECT_LE(static_cast<double>(weight) * unit,
                std::max(16.0 * static_cast<double>(zones) + unit, 0x1p24));
      EXPECT_EQ(plan.next_weight(batches + kRound - 1, done), weight) << "groups would differ";
      if (static_cast<double>(done) * unit < 1e12 &&
          static_cast<double>(done + kRound * weight) * unit >= 1e12) {
        EXPECT_LE(batches, 250'000) << zones;
      }
      last = weight;
      done += kRound * weight;
    }
  }
}

TEST(BatchPlan, ManyPacketsAreAUnitThatBatchesShare) {
  SolverSettings s;
  s.packets = 1'000'000'000'000;
  const BatchPlan plan(s, 4096);
  EXPECT_NEAR(plan.unit_packets(), 65'536, 1) << "batches grow, the first are small";
}

TEST(BatchPlan, NumbersOfBatchesAreNeverUsedTwice) {
  EXPECT_GT(BatchPlan({}, 100).next_weight((std::int64_t{1} << 32) - 2, 1), 0);
  EXPECT_EQ(BatchPlan({}, 100).next_weight((std::int64_t{1} << 32) - 1, 1), 0);
}

}  // namespace
}  // namespace reemit
