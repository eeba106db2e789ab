// Runs that are killed and resumed through the built program.
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/solution/solution_file.h"
#include "tests/support/run_program.h"
#include "tests/support/same_light.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

void expect_same_files(const fs::path& a, const fs::path& b) {
  const Solution one = load_solution(a);
  const Solution other = load_solution(b);
  expect_same_record(one.record, other.record);
  expect_same_light(one, other);
}

TEST(ResumedProgram, KilledAtAnyMomentItGoesOnToTheSameFile) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string room = (folder / "room.json").string();
  const std::string solution = (folder / "room.h5").string();
  const std::vector<std::string> rules{"--zone-area", "0.01", "--packets", "6000000"};
  std::vector<std::string> whole{"solve", room, "-o", (folder / "whole.h5").string()};
  whole.insert(whole.end(), rules.begin(), rules.end());
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run_reemit(whole).exit_code, 0);
  const auto duration = std::chrono::steady_clock::now() - start;

  std::vector<std::string> begin{"solve", room, "-o", solution, "--checkpoint", "1ms", "--threads", "1"};
  begin.insert(begin.end(), rules.begin(), rules.end());
  int killed = 0;
  for (int attempt = 1;; ++attempt) {
    const std::vector<std::string> resume{
        "solve", "--resume", solution, "--checkpoint", "1ms", "--threads", attempt % 2 == 0 ? "1" : "2"};
    RunningProgram program(fs::exists(solution) ? resume : begin);
    if (attempt > 10) {
      const ProgramRun run = program.wait();
      ASSERT_EQ(run.exit_code, 0) << run.err;
      break;
    }
    // Moments that do not repeat.
    std::this_thread::sleep_for(duration * (3 + 7 * attempt % 11) / 40);
    program.send(SIGKILL);
    if (program.wait().exit_code == -SIGKILL) ++killed;
  }
  EXPECT_GT(killed, 5) << "the others were done sooner";
  expect_same_files(folder / "whole.h5", solution);
}

TEST(ResumedProgram, HasNothingToDoWhenItsRuleHolds) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const fs::path solution = solve_small_room(folder, "room.h5");
  const std::string before = read_bytes(solution);
  for (const std::vector<std::string>& rule :
       {std::vector<std::string>{}, {"--packets", "1000"}, {"--error", "90%"}}) {
    std::vector<std::string> arguments{"solve", "--resume", solution.string()};
    arguments.insert(arguments.end(), rule.begin(), rule.end());
    const ProgramRun run = run_reemit(arguments);
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr("is solved as far as its stopping rules ask for"));
    EXPECT_EQ(read_bytes(solution), before);
  }
}

TEST(ResumedProgram, GoesOnAfterAnInterruptAndIntoAnotherFile) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const fs::path solution = solve_small_room(folder, "room.h5");
  const std::string before = read_bytes(solution);
  const fs::path more = folder / "more.h5";
  const ProgramRun run =
      run_reemit({"solve", "--resume", solution.string(), "-o", more.string(), "--packets", "40000"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_bytes(solution), before);
  EXPECT_GE(load_solution(more).record.packets, 2 * load_solution(solution).record.packets - 100);
}

TEST(ResumedProgram, GoesOnWithItsLog) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = (folder / "room.h5").string();
  const std::string log = (folder / "run.jsonl").string();
  const auto solve = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "solve");
    arguments.insert(arguments.end(), {"--log", log});
    ASSERT_EQ(run_reemit(arguments).exit_code, 0);
  };
  solve({(folder / "room.json").string(), "-o", solution, "--packets", "20000"});
  const std::string first = read_bytes(log);
  solve({"--resume", solution, "--packets", "60000"});
  const std::string both = read_bytes(log);
  EXPECT_EQ(both.substr(0, first.size()), first);
  EXPECT_THAT(both.substr(first.size()), ::testing::StartsWith(R"({"event":"start")"));
  // A new run is another thing.
  solve({(folder / "room.json").string(), "-o", solution, "--packets", "20000"});
  EXPECT_LT(read_bytes(log).size(), both.size());
}

TEST(ResumedProgram, ATimeGivenNowCountsFromWhatStands) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = solve_small_room(folder, "room.h5").string();
  const double before = load_solution(solution).record.seconds;
  ASSERT_EQ(run_reemit({"solve", "--resume", solution, "--time", "200ms"}).exit_code, 0);
  const Solution after = load_solution(solution);
  EXPECT_EQ(after.record.stopped, StopReason::kTimeLimit);
  EXPECT_DOUBLE_EQ(after.settings.time_limit_s, before + 0.2);
  EXPECT_EQ(run_reemit({"solve", "--resume", solution}).exit_code, 0);
  EXPECT_EQ(load_solution(solution).record.packets, after.record.packets) << "nothing is left of it";
}

TEST(ResumedProgram, WithoutTimeForABatchTheSolutionStaysAsItWas) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  solve_small_room(folder, "room.h5");
  const fs::path solution = folder / "room.h5";
  const std::string before = read_bytes(solution);
  const ProgramRun run = run_reemit({"solve", "--resume", solution.string(), "--time", "0.000001s"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("stays as it was"));
  EXPECT_THAT(run.out, HasSubstr("stopped: time limit reached")) << "this run, not the one before";
  EXPECT_TRUE(read_bytes(solution) == before);
  const fs::path other = folder / "other.h5";
  EXPECT_EQ(run_reemit({"solve", "--resume", solution.string(), "--time", "0.000001s", "-o", other.string()})
                .exit_code,
            0);
  expect_same_files(solution, other);
}

TEST(ResumedProgram, KeepsWhatARunHasOneOf) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = solve_small_room(folder, "room.h5").string();
  for (const std::vector<std::string>& settled :
       {std::vector<std::string>{"--seed", "7"}, {"--method", "walk"}, {"--zone-area", "0.3"}}) {
    std::vector<std::string> arguments{"solve", "--resume", solution};
    arguments.insert(arguments.end(), settled.begin(), settled.end());
    const ProgramRun run = run_reemit(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("--resume excludes " + settled.front()));
  }
  EXPECT_THAT(run_reemit({"solve", "-o", solution}).err, HasSubstr("ROOM or --resume is required"));
}

TEST(ResumedProgram, RefusesARoomThatHasChanged) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const fs::path solution = solve_small_room(folder, "room.h5");
  std::string changed = small_json_room();
  changed.replace(changed.find("0.5"), 3, "0.6");
  folder.write("room.json", changed);
  const ProgramRun run = run_reemit({"solve", "--resume", solution.string(), "--error", "0.1%"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("the room has changed since"));
}

}  // namespace
}  // namespace reemit::test
