// A run that was saved, loaded and resumed is the run without a break, bit for bit.
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/progressive_solver.h"
#include "solver/solution/solution_file.h"
#include "tests/support/never.h"
#include "tests/support/same_light.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_rooms.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::expect_same_light;
using test::expect_same_plan;
using test::expect_same_record;
using test::RoomBuilder;
using test::TempFolder;
using test::VariableFurnace;

void expect_same_result(const Solution& a, const Solution& b) {
  expect_same_record(a.record, b.record);
  expect_same_light(a, b);
  expect_same_plan(a.gather_plan, b.gather_plan);
  EXPECT_EQ(a.light_warnings, b.light_warnings);
}

/// Twenty small batches.
SolverSettings twenty_batches() {
  SolverSettings settings;
  settings.packets = 40'000;
  settings.batch_packets = 2000;
  return settings;
}

/// Large walls and a screen whose zones are too small for packets.
VariableFurnace furnace_with_small_zones() {
  VariableFurnace furnace(4);
  furnace.screen({0.3, 0.3, 0.5}, {0.01, 0, 0}, {0, 0.01, 0}, 2);
  return furnace;
}

/// With a row in the report for every surface, as a file wants it.
MeshResult mesh_of(const RoomBuilder& room) {
  MeshResult mesh = room.mesh();
  mesh.report.surfaces.resize(room.scene().surfaces.size());
  return mesh;
}

class Resume : public testing::Test {
 protected:
  Solution through_file(const Solution& solution) const {
    save_solution(solution, file_);
    return load_solution(file_);
  }
  /// Breaks off after so many batches each time, with other threads each time.
  Solution in_sittings(const RoomBuilder& room, const SolverSettings& settings, int batches) const {
    Solution stands = new_solution(room.scene(), mesh_of(room), settings);
    for (int sitting = 0;; ++sitting) {
      stands.settings.threads = 1 + sitting % 2;
      ProgressiveSolver solver(room.scene(), std::move(stands), test::kNever);
      bool goes_on = true;
      for (int i = 0; i < batches && goes_on; ++i) goes_on = solver.step();
      if (!goes_on) return solver.finish();
      stands = through_file(solver.checkpoint());
      EXPECT_EQ(stands.record.stopped, StopReason::kUnderWay);
    }
  }

  TempFolder folder_;
  std::filesystem::path file_ = folder_ / "room.h5";
};

TEST_F(Resume, AnyNumberOfBreaksLeavesNoTrace) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk})
    for (const int batches : {1, 7}) {
      SCOPED_TRACE(to_string(method) + ", " + std::to_string(batches));
      SolverSettings settings = twenty_batches();
      settings.method = method;
      const Solution whole = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
      ASSERT_GT(whole.record.gathered_zones, 0U);
      ASSERT_EQ(whole.sums.batches, 20);
      expect_same_result(whole, in_sittings(room, settings, batches));
    }
}

TEST_F(Resume, GoesOnInTheSameRoomAlone) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  const Solution whole = solve(room.scene(), mesh_of(room), twenty_batches(), {}, test::kNever);
  Scene darker = room.scene();
  for (Material& m : darker.materials) m.reflectance *= 0.3;
  const VariableFurnace other(3);
  for (const Scene* scene : {&std::as_const(darker), &other.room().scene()})
    EXPECT_THROW(ProgressiveSolver(*scene, whole, test::kNever), InputError);
  EXPECT_THROW(ProgressiveSolver(room.scene(), Solution(), test::kNever), InputError);
}

// After the last batch small zones are gathered and the zones looked at: a solution that lacks it is not
// done.
TEST_F(Resume, AnInterruptAfterTheLastBatchLeavesNoTrace) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  const SolverSettings settings = twenty_batches();
  const Solution whole = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  for (const bool before_small_zones : {false, true}) {
    std::atomic<bool> interrupt = false;
    ProgressiveSolver solver(room.scene(), new_solution(room.scene(), mesh_of(room), settings), interrupt);
    while (solver.step()) {
    }
    interrupt = before_small_zones;
    const Solution cut = through_file(solver.finish([&](const SolveProgress&) { interrupt = true; }));
    EXPECT_EQ(cut.record.stopped, StopReason::kInterrupted);
    EXPECT_EQ(cut.record.gathered_zones > 0, !before_small_zones);
    EXPECT_FALSE(cut.record.discretisation);
    expect_same_result(whole, solve(room.scene(), through_file(cut), {}, test::kNever));
  }
}

TEST_F(Resume, AFinishedSolutionGoesOnToALowerError) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  SolverSettings settings;
  settings.batch_packets = 4000;
  settings.error_target = 0.02;
  const Solution at_once = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  settings.error_target = 0.06;
  Solution first = through_file(solve(room.scene(), mesh_of(room), settings, {}, test::kNever));
  ASSERT_LT(first.sums.batches, at_once.sums.batches);
  ASSERT_GT(first.gathered.zones.size(), 0U);
  first.settings.error_target = 0.02;
  expect_same_result(at_once, solve(room.scene(), std::move(first), {}, test::kNever));
}

TEST_F(Resume, BatchesGrowAsIfThereHadBeenNoBreak) {
  // Default sizes: after sixteen batches they depend on those before.
  const VariableFurnace furnace(24);
  const RoomBuilder& room = furnace.room();
  SolverSettings settings;
  settings.packets = 5'000'000;
  const Solution whole = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  ASSERT_GT(whole.sums.weight(), whole.sums.batches) << "of unequal size";
  expect_same_result(whole, in_sittings(room, settings, 9));
}

TEST_F(Resume, MorePacketsThanAtFirstKeepTheSizeOfBatches) {
  const VariableFurnace furnace(4);
  const RoomBuilder& room = furnace.room();
  SolverSettings settings;
  settings.packets = 30'000;
  Solution first = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  const std::int64_t batches = first.sums.batches;
  const std::uint64_t unit = first.record.unit_packets;
  first.settings.packets = 60'000;
  const Solution more = solve(room.scene(), std::move(first), {}, test::kNever);
  EXPECT_EQ(more.record.unit_packets, unit);
  EXPECT_EQ(more.sums.batches, 2 * batches);
  EXPECT_EQ(more.record.stopped, StopReason::kPacketCount);
}

TEST_F(Resume, AFirstBatchThatWasCutOffIsRunAgain) {
  const VariableFurnace furnace(4);
  const RoomBuilder& room = furnace.room();
  const SolverSettings settings = twenty_batches();
  const std::atomic<bool> at_once{true};
  Solution cut_off = through_file(solve(room.scene(), mesh_of(room), settings, {}, at_once));
  ASSERT_TRUE(cut_off.record.cut_off);
  const Solution whole = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  expect_same_result(whole, solve(room.scene(), std::move(cut_off), {}, test::kNever));
}

TEST_F(Resume, ATimeLimitIsThatOfAllSittings) {
  const VariableFurnace furnace(4);
  const RoomBuilder& room = furnace.room();
  Solution stands = solve(room.scene(), mesh_of(room), twenty_batches(), {}, test::kNever);
  stands.record.seconds = 3600;
  stands.settings.packets = 0;
  stands.settings.time_limit_s = 3600.5;
  const Solution more = solve(room.scene(), std::move(stands), {}, test::kNever);
  EXPECT_EQ(more.record.stopped, StopReason::kTimeLimit);
  EXPECT_GT(more.record.seconds, 3600);
  // Not another hour; how punctual it is depends on the machine.
  EXPECT_LT(more.record.seconds, 3660);
  EXPECT_EQ(more.settings.time_limit_s, 3600.5) << "as it was asked for";
}

TEST_F(Resume, EndingTwiceGathersOnce) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  SolverSettings settings;
  settings.batch_packets = 4000;
  settings.packets = 80'000;
  ProgressiveSolver solver(room.scene(), new_solution(room.scene(), mesh_of(room), settings), test::kNever);
  while (solver.step()) {
  }
  solver.end();
  const Solution once = solver.solution();
  ASSERT_GT(once.gathered.rays, 0U);
  const Solution twice = solver.finish();
  expect_same_result(once, twice);
  EXPECT_EQ(once.record.rays, twice.record.rays);
  EXPECT_EQ(once.gathered.sums, twice.gathered.sums) << "what a run that goes on puts back";
}

TEST_F(Resume, TellsWhichRuleHoldsAlready) {
  const VariableFurnace furnace = furnace_with_small_zones();
  const RoomBuilder& room = furnace.room();
  SolverSettings settings;
  settings.batch_packets = 4000;
  settings.error_target = 0.05;
  Solution solution = solve(room.scene(), mesh_of(room), settings, {}, test::kNever);
  ASSERT_GT(solution.gathered.zones.size(), 0U);
  EXPECT_EQ(rule_that_holds(room.scene(), solution), StopReason::kErrorTarget);
  solution.settings.error_target = 0.01;
  EXPECT_EQ(rule_that_holds(room.scene(), solution), std::nullopt);
  solution.settings.packets = 1;
  EXPECT_EQ(rule_that_holds(room.scene(), solution), StopReason::kPacketCount);
}

}  // namespace
}  // namespace reemit
