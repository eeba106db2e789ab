// What signals do to a run of the built program.
#include <chrono>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
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
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TempFolder folder;
    folder.write("room.json", small_json_room());
    RunningProgram program = start_endless_solve(folder);
    wait_for_progress(program);
    // A ray at least, or there is nothing to keep.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
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

/// In a room where light goes round some million times, so that a first batch takes long.
TEST(Interrupt, PartOfAFirstBatchReplacesNoSolution) {
  const TempFolder folder;
  folder.write("room.json", R"({"format": "reemit-room", "version": 1, "bands": "grey",
    "materials": {"white": {"reflectance": 0.999999}, "lamp": {"reflectance": 0.5, "exitance": 1}},
    "objects": [{"material": "white", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}},
                {"material": "lamp", "quad": {"corner": [0.5, 0.5, 0.5], "u": [0.001, 0, 0], "v": [0, 0.001, 0]}}]})");
  const std::string room = (folder / "room.json").string();
  const std::string output = (folder / "room.h5").string();
  ASSERT_EQ(run_reemit({"solve", room, "-o", output, "--zones", "200", "--time", "0.2s"}).exit_code, 0);
  const std::string previous = read_bytes(output);
  RunningProgram program(
      {"solve", room, "-o", output, "--zones", "200", "--packets", "1000000000", "--verbose"});
  wait_for_progress(program);
  program.send(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_THAT(run.err, HasSubstr("interrupted in the first batch; nothing was written"));
  EXPECT_TRUE(read_bytes(output) == previous);
}

std::string solve_for_no_time(const TempFolder& folder) {
  const std::string solution = (folder / "room.h5").string();
  const ProgramRun run =
      run_reemit({"solve", (folder / "room.json").string(), "-o", solution, "--time", "0.000001s", "--json"});
  EXPECT_EQ(run.exit_code, 0);
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_THAT(document["warnings"].dump(), HasSubstr("still on its way"));
  EXPECT_THAT(document["warnings"].dump(), HasSubstr("after one batch"));
  return solution;
}

TEST(Interrupt, WhatIsMadeOfAPartOfABatchSaysSo) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = solve_for_no_time(folder);
  const std::string out = (folder / "out").string();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"measure", solution, "--grid", "0.2,0.2,0.2", "0.5,0,0", "0,0,0.5", "2x2"},
        {"export", solution, "-o", out + ".csv", "--samples", "16"},
        {"render", solution, "-o", out + ".png", "--size", "16x12", "--spp", "1"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back("--json");
    const ProgramRun run = run_reemit(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto document = nlohmann::json::parse(run.out);
    EXPECT_THAT(document["warnings"].dump(), HasSubstr("after one batch")) << run.out;
    EXPECT_THAT(run.err, HasSubstr("after one batch"));
    const auto& result = document.contains("pictures") ? document["pictures"][0] : document;
    EXPECT_TRUE(result["error"].is_null()) << run.out;
  }
}

/// Of two pictures in a folder one is not made.
TEST(Interrupt, PicturesThatAreMissingAreNotDone) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = solve_small_room(folder, "room.h5").string();
  RunningProgram program({"render", solution, "--camera", "all", "--size", "512x512", "--error", "0.01%",
                          "-o", (folder / "pictures/").string(), "--format", "png", "--json", "--verbose"});
  for (int i = 0; i < 2000 && program.errors_so_far().find("rendering") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.send(SIGTERM);
  const ProgramRun run = program.wait();
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_EQ(document["pictures"].size(), 1U);
  EXPECT_EQ(document["pictures_wanted"], 2);
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_TRUE(document["pictures"][0]["interrupted"].get<bool>());
}

TEST(Interrupt, KilledRunKeepsThePreviousSolution) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string previous = read_bytes(solve_small_room(folder, "room.h5"));
  RunningProgram program = start_endless_solve(folder);
  wait_for_progress(program);
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, -SIGKILL);
  EXPECT_TRUE(read_bytes(folder / "room.h5") == previous);
}

/// Boxes that all pass through their neighbours, so that meshing takes its time.
std::string crossing_boxes(int count) {
  std::string boxes;
  for (int i = 0; i < count * count * count; ++i) {
    const double x = 0.7 * (i % count), y = 0.7 * (i / count % count), z = 0.7 * (i / count / count);
    boxes += fmt::format(R"({{"material": "lamp", "box": {{"min": [{}, {}, {}], "max": [{}, {}, {}]}}}},)", x,
                         y, z, x + 0.9, y + 0.8, z + 0.85);
  }
  boxes.pop_back();
  return R"({"format": "reemit-room", "version": 1, "bands": "rgb",
    "materials": {"lamp": {"reflectance": 0.5, "exitance": 1}}, "objects": [)" +
         boxes + "]}";
}

TEST(Interrupt, MeshingEndsAtOnceAndLeavesNothing) {
  const TempFolder folder;
  folder.write("room.json", crossing_boxes(12));
  RunningProgram program({"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string()});
  // What was assumed about the file is said between reading and meshing.
  for (int i = 0; i < 2000 && program.errors_so_far().find("has a colour") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.send(SIGINT);
  const auto sent = std::chrono::steady_clock::now();
  const ProgramRun run = program.wait();
  EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(1));
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_THAT(run.err, HasSubstr("reemit: error: interrupted before there was a result"));
  EXPECT_THAT(folder.listing(), ElementsAre("room.json"));
}

}  // namespace
}  // namespace reemit::test
