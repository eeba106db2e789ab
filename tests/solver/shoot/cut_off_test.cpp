// Batches that are cut off, and rooms whose light goes on for ever: the books stay exact, and somebody is
// told.

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/shoot/packet_batch.h"
#include "tests/solver/shoot/methods.h"
#include "tests/support/never.h"
#include "tests/support/refusal.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

using test::kMethods;

/// A sealed room with a lamp in one wall; a batch of default size takes minutes in it.
RoomBuilder sealed_room(double reflectance) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", reflectance);
  const MaterialId lamp = room.material("lamp", reflectance, 3);
  room.box(Vec3::Zero(), Vec3(4, 3, 5), {wall, wall, wall, wall, wall, lamp}, 8);
  return room;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void expect_exact_books(const Solution& s) {
  for (const BandAudit& band : s.audit.bands) {
    EXPECT_EQ(band.emitted, s.audit.weight * kBatchQuanta);
    EXPECT_EQ(band.emitted, band.total_absorbed() + band.total_escaped() + band.unshot);
  }
}

TEST(CutOff, TimeLimitHoldsWithinTheFirstBatch) {
  for (const SolveMethod method : kMethods) {
    SolverSettings settings;
    settings.method = method;
    settings.time_limit_s = 0.5;
    const RoomBuilder room = sealed_room(0.9999);
    Solution s;
    const double seconds =
        seconds_of([&] { s = solve(room.scene(), room.mesh(), settings, nullptr, test::kNever); });
    EXPECT_LT(seconds, 10) << "asked for 0.5 s; allowed more only because tests run on busy machines";
    EXPECT_EQ(s.record.stopped, StopReason::kTimeLimit) << to_string(method);
    EXPECT_EQ(s.sums.batches, 1);
    EXPECT_EQ(s.record.error, std::numeric_limits<double>::infinity());
    EXPECT_GT(s.audit.unshot_share(), 0.01);
    expect_exact_books(s);
  }
}

TEST(CutOff, InterruptHoldsWithinTheFirstBatch) {
  for (const SolveMethod method : kMethods) {
    SolverSettings settings;
    settings.method = method;
    settings.packets = 1'000'000;
    const RoomBuilder room = sealed_room(0.9999);
    std::atomic<bool> interrupt{false};
    Solution s;
    std::thread user([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      interrupt = true;
    });
    const double seconds =
        seconds_of([&] { s = solve(room.scene(), room.mesh(), settings, nullptr, interrupt); });
    user.join();
    EXPECT_LT(seconds, 10);
    EXPECT_EQ(s.record.stopped, StopReason::kInterrupted) << to_string(method);
    EXPECT_EQ(s.sums.batches, 1);
    expect_exact_books(s);
  }
}

TEST(CutOff, WhatHasNotSetOutIsUnshot) {
  // Three bands and packets that do not divide: every quantum must be found.
  RoomBuilder room(BandSet::rgb());
  const MaterialId wall = room.material("wall", 0.5);
  const MaterialId lamp = room.material("lamp", room.flat(0.5), Spectrum(Eigen::Array3d(7, 1, 0.3)));
  room.box(Vec3::Zero(), Vec3::Ones(), {lamp, wall, lamp, wall, wall, wall}, 3);
  const std::atomic<bool> already{true};
  for (const SolveMethod method : kMethods)
    for (const std::uint64_t packets : {1U, 37U, 5001U, 65536U}) {
      SolverSettings settings;
      settings.method = method;
      settings.batch_packets = packets;
      const Solution s = solve(room.scene(), room.mesh(), settings, nullptr, already);
      EXPECT_EQ(s.record.stopped, StopReason::kInterrupted);
      expect_exact_books(s);
      for (const BandAudit& band : s.audit.bands) EXPECT_EQ(band.unshot, band.emitted);
    }
}

TEST(CutOff, BatchThatIsCutOffIsLeftOutIfThereAreOthers) {
  for (const SolveMethod method : kMethods) {
    std::atomic<bool> interrupt{false};
    SolverSettings settings;
    settings.method = method;
    settings.batch_packets = 10'000;
    const RoomBuilder room = sealed_room(0.5);
    const auto stop_after_two = [&](const SolveProgress& p) { interrupt = p.batches == 2; };
    const Solution s = solve(room.scene(), room.mesh(), settings, stop_after_two, interrupt);
    EXPECT_EQ(s.sums.batches, 2);
    EXPECT_LE(s.audit.unshot_share(), settings.stop_share);
    expect_exact_books(s);
  }
}

TEST(CutOff, InterruptAfterTheLastBatchCutsTheExaminationShort) {
  std::atomic<bool> interrupt{false};
  SolverSettings settings;
  settings.packets = 200'000;
  const RoomBuilder room = sealed_room(0.5);
  bool examines = false;
  const auto stop_then = [&](const SolveProgress& p) {
    examines = examines || p.examines;
    interrupt = examines;
  };
  const Solution s = solve(room.scene(), room.mesh(), settings, stop_then, interrupt);
  EXPECT_TRUE(examines);
  EXPECT_EQ(s.record.stopped, StopReason::kInterrupted) << "it would pass for finished";
  EXPECT_GT(s.sums.batches, 1);
  EXPECT_LT(s.record.error_bound, 1);
  EXPECT_FALSE(s.record.discretisation.has_value());
  EXPECT_FALSE(s.record.gather_bias.has_value());
  EXPECT_THAT(s.light_warnings,
              ElementsAre(HasSubstr("interrupted before it had looked for light that is lost")));
  expect_exact_books(s);
}

TEST(CutOff, WhatComesBeforeTheFirstBatchCanBeStoppedWithoutAResult) {
  SolverSettings settings;
  settings.packets = 10'000;
  const RoomBuilder room = sealed_room(0.5);
  const std::atomic<bool> already{true};
  EXPECT_THROW(solve(room.scene(), new_solution(room.scene(), room.mesh(), settings),
                     {.preparing = WorkWatch({}, StopToken(already))}, test::kNever),
               Interrupted);
  std::vector<double> told;
  SolveWatch watch;
  watch.progress = [&](const SolveProgress&) { EXPECT_EQ(told.back(), 1); };
  watch.preparing = WorkWatch([&](double done) { told.push_back(done); });
  const Solution s =
      solve(room.scene(), new_solution(room.scene(), room.mesh(), settings), watch, test::kNever);
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(told.back(), 1);
}

TEST(CutOff, BounceLimitKeepsTheBooksAndIsNoErrorTarget) {
  // One part in a million is absorbed: 200,000 bounces leave exp(-0.2) = 82 % of the power.
  for (const SolveMethod method : kMethods) {
    SolverSettings settings;
    settings.method = method;
    settings.batch_packets = 1;
    settings.error_target = 0.8;
    settings.smallest_batch_count = 2;
    settings.threads = 1;
    RoomBuilder box;
    const MaterialId wall = box.material("wall", 0.999999);
    box.box(Vec3::Zero(), Vec3::Ones(), {wall, wall, wall, wall, wall, wall}, 1);
    box.scene().lights = {PointLight{"lamp", Vec3(0.5, 0.5, 0.5), box.flat(1)}};
    const Solution s = solve(box.scene(), box.mesh(), settings, nullptr, test::kNever);
    expect_exact_books(s);
    // A single walk may as well be absorbed early.
    if (method == SolveMethod::kWalk) continue;
    EXPECT_NEAR(s.audit.unshot_share(), 0.8187, 0.001);
    EXPECT_EQ(s.record.stopped, StopReason::kBounceLimit);
  }
}

std::string refusal(const RoomBuilder& room) {
  SolverSettings settings;
  settings.packets = 2'000;
  return test::refusal_of([&] { solve(room.scene(), room.mesh(), settings, nullptr, test::kNever); });
}

/// A lit grey room around a small cell of `inside`, open towards +z if asked for; surfaces 6.. are the
/// cell's.
RoomBuilder room_with_cell(double inside, double exitance, bool open) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 1);
  const MaterialId shell = room.material("shell", inside);
  const MaterialId lamp = room.material("lamp", inside, exitance);
  room.box(Vec3(-5, -5, -5), Vec3(5, 5, 5), {wall, wall, wall, wall, wall, wall}, 2);
  room.box(Vec3(0, 0, 0), Vec3(1, 1, 1), {lamp, shell, shell, shell, shell, open ? MaterialId() : shell}, 2);
  return room;
}

TEST(ClosedRoomCheck, FindsASealedCellWithinARoomAndNamesIt) {
  EXPECT_THAT(refusal(room_with_cell(1, 2, false)),
              AllOf(HasSubstr("luminaire 'quad6'"), HasSubstr("'quad6', 'quad7', 'quad8'"),
                    HasSubstr("'quad11'"), Not(HasSubstr("'quad5'"))));
}

TEST(ClosedRoomCheck, TakesCellsThatAreOpenOrDarkOrGrey) {
  EXPECT_EQ(refusal(room_with_cell(1, 2, true)), "accepted");
  EXPECT_EQ(refusal(room_with_cell(1, 0, false)), "accepted");
  EXPECT_EQ(refusal(room_with_cell(0.99, 2, false)), "accepted");
}

TEST(ClosedRoomCheck, FindsPunctualLuminairesInSealedParts) {
  RoomBuilder room = room_with_cell(1, 0, false);
  room.scene().lights = {PointLight{"bulb", Vec3(0.5, 0.5, 0.5), room.flat(1)}};
  EXPECT_THAT(refusal(room), HasSubstr("luminaire 'bulb'"));
  room.scene().lights = {PointLight{"bulb", Vec3(2, 2, 2), room.flat(1)}};
  EXPECT_EQ(refusal(room), "accepted");
}

}  // namespace
}  // namespace reemit
