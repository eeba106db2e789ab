// Rooms whose light goes on and on: limits hold, and the user is told what is missing.
#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string sealed_room(const std::string& reflectance) {
  return R"({"format": "reemit-room", "version": 1, "materials": {"white": {"reflectance": )" + reflectance +
         R"(}, "lamp": {"reflectance": )" + reflectance +
         R"(, "radiance": 10}, "grey": {"reflectance": 0.5}},
         "objects": [
           {"material": "white", "name": "cell", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}},
           {"material": "lamp", "name": "tube", "quad": {"corner": [0.3, 0.9, 0.3], "u": [0.4, 0, 0], "v": [0, 0, 0.4]}},
           {"material": "grey", "name": "hall", "box": {"min": [-4, -4, -4], "max": [4, 4, 4], "inward": true}}]})";
}

TEST(SealedRoom, TimeLimitHoldsAndTheUserIsToldWhatIsMissing) {
  for (const char* method : {"shooting", "walk"}) {
    const TempFolder folder;
    folder.write("room.json", sealed_room("0.9999"));
    const std::string solution = (folder / "room.h5").string();
    const ProgramRun run = run_reemit(
        {"solve", (folder / "room.json").string(), "-o", solution, "--method", method, "--time", "1s"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("time limit reached"));
    EXPECT_THAT(run.err, AllOf(HasSubstr("still on its way"), HasSubstr("after one batch")));
    EXPECT_EQ(run_reemit({"audit", solution}).exit_code, 0) << "the books are exact";
    EXPECT_THAT(run_reemit({"info", solution}).out, HasSubstr("unshot"));
  }
}

TEST(SealedRoom, SignalEndsTheFirstBatch) {
  const TempFolder folder;
  folder.write("room.json", sealed_room("0.9999"));
  const std::string solution = (folder / "room.h5").string();
  RunningProgram program({"solve", (folder / "room.json").string(), "-o", solution});
  // The note comes just before the solve.
  for (int i = 0; i < 600 && program.errors_so_far().find("no stopping rule") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.send(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("interrupted"));
  EXPECT_EQ(run_reemit({"audit", solution}).exit_code, 0);
}

TEST(SealedRoom, PerfectPartIsNamed) {
  const TempFolder folder;
  folder.write("room.json", sealed_room("1"));
  const ProgramRun run = run_reemit(
      {"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string(), "--time", "5s"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("'tube'"), HasSubstr("'cell'"), HasSubstr("no finite value")));
}

}  // namespace
}  // namespace reemit::test
