#include "solver/tally/stop_rule.h"

#include <limits>

#include <gtest/gtest.h>

#include "solver/tally/batch_books.h"

namespace reemit {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr std::size_t kManyZones = 1'000'000;

StopRule rule_of(const SolverSettings& settings, std::size_t zones = 100) {
  return StopRule(settings, BatchPlan(settings, zones), settings.time_limit_s);
}

/// `batches` of weight 1.
RunState after(std::int64_t batches, double error, double seconds = 1) {
  RunState state;
  state.batches = batches;
  state.weight = batches;
  state.error = error;
  state.seconds = seconds;
  return state;
}

TEST(StopRule, ErrorIsBelievedOnlyAfterEnoughBatches) {
  SolverSettings s;
  s.error_target = 0.01;
  const StopRule rule = rule_of(s);
  EXPECT_FALSE(rule.stop(after(15, 0.001)));
  EXPECT_EQ(rule.stop(after(16, 0.01)), StopReason::kErrorTarget);
  EXPECT_FALSE(rule.stop(after(16, 0.0101)));
  EXPECT_FALSE(rule.stop(after(100, kUnknown)));
}

TEST(StopRule, NoTargetIsReachedWhilePowerIsUnshot) {
  SolverSettings s;
  s.error_target = 0.01;
  RunState state = after(16, 0.001);
  state.unshot_share = 0.02;
  EXPECT_EQ(rule_of(s).stop(state), StopReason::kBounceLimit);
  state.unshot_share = 1e-5;
  EXPECT_EQ(rule_of(s).stop(state), StopReason::kErrorTarget);
}

TEST(StopRule, StopsWhenPacketsAreSpent) {
  SolverSettings s;
  s.packets = 1'000'000;
  EXPECT_FALSE(rule_of(s).stop(after(15, 1)));
  EXPECT_EQ(rule_of(s).stop(after(16, 1)), StopReason::kPacketCount);
}

TEST(StopRule, AnErrorTargetIsPursuedForAsLongAsItTakes) {
  SolverSettings s;
  s.error_target = 1e-9;
  RunState state = after(1'000'000, 1e-3);
  state.weight = std::int64_t{1} << 40;  // 7 x 10^16 packets
  EXPECT_GT(rule_of(s).next_weight(state), 0);
  EXPECT_FALSE(rule_of(s).stop(state));
  state.batches = std::numeric_limits<std::uint32_t>::max();
  EXPECT_EQ(rule_of(s).stop(state), StopReason::kBatchLimit);
}

TEST(StopRule, BatchesShrinkToTheTimeLeft) {
  SolverSettings s;
  s.time_limit_s = 10;
  const StopRule rule = rule_of(s, kManyZones);
  RunState state = after(1600, 1, 8);
  state.weight = 1'000'000;
  state.batch_seconds = 0.05;  // a full batch, of weight 64, would take 3.2 s
  EXPECT_FALSE(rule.stop(state));
  EXPECT_EQ(rule.next_weight(state), 40);
  state.shortened = true;
  EXPECT_EQ(rule.stop(state), StopReason::kTimeLimit) << "even if an error target were met as well";
}

TEST(StopRule, TimeStopsBeforeABatchThatWouldEndBeyondIt) {
  SolverSettings s;
  s.time_limit_s = 10;
  const StopRule rule = rule_of(s);
  RunState state = after(4, 1, 7.5);
  state.batch_seconds = 2;
  EXPECT_FALSE(rule.stop(state));
  state.seconds = 8.5;
  EXPECT_EQ(rule.stop(state), StopReason::kTimeLimit);
  state.batches = 1;
  EXPECT_FALSE(rule.stop(state)) << "one batch has no standard error";
}

TEST(StopRule, ProgressFollowsTheSquareOfTheError) {
  SolverSettings s;
  s.error_target = 0.01;
  EXPECT_NEAR(rule_of(s).fraction_done(after(100, 0.02)), 0.25, 1e-12);
  s.time_limit_s = 2;
  EXPECT_NEAR(rule_of(s).fraction_done(after(100, 0.02)), 0.5, 1e-12);
}

}  // namespace
}  // namespace reemit
