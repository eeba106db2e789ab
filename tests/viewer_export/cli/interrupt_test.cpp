// What signals do to a run of the built program.
#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A solve that would take far longer than the test.
RunningProgram start_endless_solve(const TempFolder& folder) {
  return RunningProgram({"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string(),
                         "--zone-area", "0.05", "--time", "1h", "--verbose"});
}

/// Waits for the first line of progress: the handlers are in place by then.
void wait_for_progress(const RunningProgram& program) {
  for (int i = 0; i < 600 && program.errors_so_far().find("solving") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_THAT(program.errors_so_far(), HasSubstr("solving"));
}

TEST(Interrupt, FirstSignalKeepsTheSolutionSoFar) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TempFolder folder;
    folder.write("room.json", small_json_room());
    RunningProgram program = start_endless_solve(folder);
    wait_for_progress(program);
    program.send(signal);
    const ProgramRun run = program.wait();
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("interrupted"));
    EXPECT_THAT(run.err, HasSubstr("the solution so far is in"));
    EXPECT_THAT(folder.listing(), ElementsAre("room.h5", "room.json"));
    EXPECT_EQ(run_reemit({"audit", (folder / "room.h5").string()}).exit_code, 0);
  }
}

TEST(Interrupt, SecondSignalLeavesNoHalfFile) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  RunningProgram program = start_endless_solve(folder);
  wait_for_progress(program);
  program.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  program.send(SIGINT);
  const ProgramRun run = program.wait();
  // The second one meets the solver, the writing of the file, or a program that has just finished.
  EXPECT_THAT(run.exit_code, AnyOf(0, 128 + SIGINT, -SIGINT)) << run.err;
  EXPECT_THAT(folder.listing(), AnyOf(ElementsAre("room.json"), ElementsAre("room.h5", "room.json")));
  if (std::filesystem::exists(folder / "room.h5")) {
    EXPECT_EQ(run_reemit({"audit", (folder / "room.h5").string()}).exit_code, 0);
  }
}

TEST(Interrupt, KilledRunKeepsThePreviousSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  folder.write("room.h5", "the previous one");
  RunningProgram program = start_endless_solve(folder);
  wait_for_progress(program);
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, -SIGKILL);
  EXPECT_TRUE(read_bytes(folder / "room.h5") == "the previous one");
}

}  // namespace
}  // namespace reemit::test
