#include "solver/tally/stop_rule.h"

#include <limits>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

TEST(StopRule, ErrorIsBelievedOnlyAfterEnoughBatches) {
  SolverSettings s;
  s.error_target = 0.01;
  const StopRule rule(s, 100);
  EXPECT_FALSE(rule.stop({15, 1000, 0.001, 1, false}));
  EXPECT_EQ(rule.stop({16, 1000, 0.01, 1, false}), StopReason::kErrorTarget);
  EXPECT_FALSE(rule.stop({16, 1000, 0.0101, 1, false}));
  EXPECT_FALSE(rule.stop({100, 1000, kUnknown, 1, false}));
}

TEST(StopRule, PacketsAreSpentInWholeBatches) {
  SolverSettings s;
  s.packets = 1'000'000;
  const StopRule rule(s, 100);
  EXPECT_EQ(rule.batch_packets(), 62'500U);
  EXPECT_FALSE(rule.stop({15, 0, 1, 1, false}));
  EXPECT_EQ(rule.stop({16, 0, 1, 1, false}), StopReason::kPacketCount);
  s.packets = 10;
  EXPECT_EQ(StopRule(s, 100).batch_packets(), 1U);
}

TEST(StopRule, TimeStopsBeforeABatchThatWouldEndBeyondIt) {
  SolverSettings s;
  s.time_limit_s = 10;
  const StopRule rule(s, 100);
  EXPECT_FALSE(rule.stop({4, 0, 1, 8, false}));
  EXPECT_EQ(rule.stop({4, 0, 1, 9.2, false}), StopReason::kTimeLimit);
  EXPECT_FALSE(rule.stop({1, 0, kUnknown, 60, false})) << "one batch has no standard error";
}

TEST(StopRule, InterruptWins) {
  SolverSettings s;
  s.error_target = 0.5;
  EXPECT_EQ(StopRule(s, 1).stop({9, 0, 0.1, 1, true}), StopReason::kInterrupted);
}

TEST(StopRule, BatchesGrowWithTheNumberOfZones) {
  EXPECT_EQ(StopRule({}, 100).batch_packets(), 65'536U);
  EXPECT_EQ(StopRule({}, 1'000'000).batch_packets(), 16'000'000U);
}

TEST(StopRule, ProgressFollowsTheSquareOfTheError) {
  SolverSettings s;
  s.error_target = 0.01;
  const StopRule rule(s, 100);
  EXPECT_NEAR(rule.fraction_done({100, 0, 0.02, 1, false}), 0.25, 1e-12);
  s.time_limit_s = 2;
  EXPECT_NEAR(StopRule(s, 100).fraction_done({100, 0, 0.02, 1, false}), 0.5, 1e-12);
}

}  // namespace
}  // namespace reemit
