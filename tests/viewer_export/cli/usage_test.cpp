#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/solved_room.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Usage, HelpOfEveryCommandShowsExamples) {
  for (const char* command : {"", "solve", "render", "export", "measure", "audit", "info"}) {
    std::vector<std::string> arguments{"--help"};
    if (*command != '\0') arguments.insert(arguments.begin(), command);
    const ProgramRun run = run_reemit(arguments);
    EXPECT_EQ(run.exit_code, 0) << command;
    EXPECT_THAT(run.out, HasSubstr("Example")) << command;
    EXPECT_THAT(run.err, IsEmpty()) << command;
  }
}

TEST(Usage, VersionGoesToStandardOutput) {
  const ProgramRun run = run_reemit({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out.rfind("reemit ", 0), 0U) << run.out;
}

struct Misuse {
  std::vector<std::string> arguments;
  std::string message;  ///< Part of what it says.
};

TEST(Usage, MistakesEndWithCode2AndAHint) {
  const std::vector<Misuse> misuses{
      {{}, "subcommand is required"},
      {{"solv", "room.json"}, "did you mean 'solve'"},
      {{"solve", "room.json", "-o", "x.h5", "--eror", "1%"}, "did you mean '--error'"},
      {{"solve", "room.json"}, "--output is required"},
      {{"solve", "-o", "x.h5"}, "ROOM or --resume is required"},
      {{"solve", "room.json", "-o", "x.h5", "--error", "5"}, "write 1% or 0.01"},
      {{"solve", "room.json", "-o", "x.h5", "--time", "soon"}, "2min"},
      {{"solve", "room.json", "-o", "x.h5", "--packets", "-5"}, "1e6"},
      {{"solve", "room.json", "-o", "x.h5", "--seed", "-1"}, "--seed"},
      {{"solve", "room.json", "-o", "x.h5", "--threads", "-1"}, "--threads"},
      {{"solve", "room.json", "-o", "x.h5", "--method", "magic"}, "--method"},
      {{"solve", "room.json", "-o", "x.h5", "--zone-area", "0"}, "number above 0"},
      {{"solve", "room.json", "-o", "x.h5", "--zone-area", "1", "--zone-area", "2"}, "--zone-area"},
      {{"render", "x.h5", "-o", "x.png", "--size", "640"}, "640x480"},
      {{"render", "x.h5", "-o", "x.png", "--eye", "1,2"}, "X,Y,Z"},
      {{"render", "x.h5", "-o", "x.png", "--eye", "1,2,3"}, "--look-at"},
      {{"render", "x.h5", "-o", "x.png", "--eye", "1", "2", "3"}, "write --eye 1,2,3"},
      {{"render", "--look-at=1,", "-2,", "3", "x.h5", "-o", "x.png"}, "write --look-at 1,-2,3"},
      {{"render", "x.h5", "-o", "x.png", "--camera", ""}, "nothing is given"},
      {{"solve", "room.json", "-o", "x.h5", "--sky", ""}, "nothing is given"},
      {{"solve", "room.json", "-o", "x.h5", "--sun", " "}, "nothing is given"},
      {{"render", "x.h5", "-o", "x.png", "--camera", "front", "--fov", "50"}, "is for a view by --eye"},
      {{"render", "x.h5", "-o", "x.exr", "--exposure", "1"}, ".exr pictures hold radiance"},
      {{"render", "x.h5", "-o", "x.png", "--format", "png"}, "for pictures in a folder"},
      {{"render", "x.h5", "-o", "x.png", "--bands", "400:700:10"}, "x.h5 is a solution"},
      {{"info", "x.h5", "--sky", "overcast:10000lx"}, "x.h5 is a solution"},
      {{"export", "x.h5", "-o", "x.csv", "--values", "zones", "--samples", "8"}, "are not gathered"},
      {{"export", "x.h5", "-o", "x.csv", "--exposure", "1"}, "shows colours"},
      {{"render", "x.h5", "-o", "x.png", "--up", "0,0,1"}, "own up direction"},
      {{"solve", "missing.json", "-o", "x.h5"}, "missing.json: there is no such file"},
      {{"info", "missing.h5"}, "missing.h5: there is no such file"},
      {{"export", "missing.h5", "-o", "x.ply"}, "missing.h5: there is no such file"},
      {{"render", "x.h5", "-o", "x.png", "--spp", "4", "--error", "1%"}, "excludes"},
      {{"render", "x.h5", "-o", "x.gif"}, ".gif"},
      {{"export", "x.h5", "-o", "x.xyz"}, ".xyz"},
      {{"render", "x.h5", "-o", "x.png", "--integrator", "zones", "--light-selection", "linear"},
       "shadow rays"},
      {{"export", "x.h5", "-o", "x.csv", "--form-factors", "--room", "r.json"}, "--room"},
      {{"audit", "x.h5", "--room", "r.json"}, "--direct"},
      {{"audit"}, "solution is required"},
      {{"audit", "a", "b"}, "unknown argument 'b'"},
  };
  for (const Misuse& misuse : misuses) {
    const ProgramRun run = run_reemit(misuse.arguments);
    std::string line = "reemit";
    for (const std::string& argument : misuse.arguments) line += ' ' + argument;
    EXPECT_EQ(run.exit_code, 2) << line;
    EXPECT_THAT(run.err, HasSubstr("reemit: error: ")) << line;
    EXPECT_THAT(run.err, HasSubstr(misuse.message)) << line;
    EXPECT_THAT(run.out, IsEmpty()) << line;
  }
}

TEST(Usage, SolutionsAreNotSolvedAnew) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  solve_small_room(folder, "room.h5");
  const std::string solution = (folder / "room.h5").string();
  const ProgramRun run = run_reemit({"solve", solution, "-o", (folder / "other.h5").string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--resume " + solution));
}

TEST(Usage, OptionsForGltfAreRefusedWhereNothingIsGltf) {
  const TempFolder folder;
  const std::string room = folder.write("room.json", small_json_room()).string();
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--emissive-units", "cd/m2"}, {"--gltf-light-efficacy", "100"}}) {
    const ProgramRun run = run_reemit({"info", room, option[0], option[1]});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(option[0] + ": is for glTF")) << run.err;
  }
}

TEST(Usage, MissingFoldersAreNamed) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string room = (folder / "room.json").string();
  const std::string solution = solve_small_room(folder, "room.h5").string();
  const std::string missing = (folder / "none").string();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"solve", room, "-o", missing + "/x.h5"},
        {"export", solution, "-o", missing + "/x.csv"},
        {"render", solution, "-o", missing + "/x.png"},
        {"render", solution, "-o", missing + "/pictures/"},
        {"render", solution, "-o", missing + "/x.png", "--camera", "front"}}) {
    const ProgramRun run = run_reemit(command);
    EXPECT_EQ(run.exit_code, 2) << command.front();
    EXPECT_THAT(run.err, HasSubstr("there is no folder '" + missing + "'")) << command.front();
  }
}

TEST(Usage, FullStandardOutputIsReported) {
  RunOptions options;
  options.stdout_path = "/dev/full";
  const ProgramRun run = run_reemit({"--help"}, options);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("cannot write"));
}

}  // namespace
}  // namespace reemit::test
