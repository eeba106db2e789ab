// What the program says about light that is lost and about the units of lamps: on standard error, with
// --json, and from the solution file.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class LightWarnings : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static ProgramRun run(const std::vector<std::string>& arguments) {
    ProgramRun result = run_reemit(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
  std::vector<std::string> solve(const std::string& room) const {
    return {"solve", path(room), "-o", path("room.h5"), "--packets", "20000", "--json"};
  }

  /// The small box lit by a luminaire 50 cm x 25 cm x 10 cm at the middle of its ceiling.
  void write_measured(const std::string& more) {
    folder_.write("lamp.ies",
                  "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.5 0.25 0.1\n1 1 10\n0 45 90\n0\n100 70 0\n");
    std::string room = replaced(small_json_room(), R"(, "exitance": [30, 25, 20])", "");
    room = replaced(room, "[0.4, 0.98, 0.4]", "[0.4, 0.3, 0.4]");  // a shelf, out of the way
    room = replaced(
        room, "\"cameras\"",
        R"("lights": [{"type": "ies", "name": "panel", "file": "lamp.ies", "position": [0.5, 1, 0.5])" +
            more + R"(}], "cameras")");
    folder_.write("room.json", room);
  }

  TempFolder folder_;
};

TEST_F(LightWarnings, AnOpeningAcrossTheCeilingIsNamedEverywhere) {
  write_measured("");
  const auto named = AllOf(HasSubstr("light 'panel'"), HasSubstr("of its light is lost"), HasSubstr("walls"));
  EXPECT_THAT(run({"info", path("room.json")}).err, named);
  EXPECT_THAT(json::parse(run({"info", path("room.json"), "--json"}).out)["warnings"], Contains(named));
  const ProgramRun solved = run(solve("room.json"));
  EXPECT_THAT(solved.err, named);
  EXPECT_THAT(json::parse(solved.out)["warnings"], Contains(named));
  EXPECT_THAT(run({"info", path("room.h5")}).err, named);
  EXPECT_THAT(json::parse(run({"info", path("room.h5"), "--json"}).out)["warnings"], Contains(named));
}

TEST_F(LightWarnings, MountedOnTheCeilingItLosesNothing) {
  write_measured(R"(, "mount": "ceiling")");
  EXPECT_THAT(run({"info", path("room.json")}).err, Not(HasSubstr("lost")));
  const ProgramRun solved = run(solve("room.json"));
  EXPECT_THAT(solved.err, Not(HasSubstr("lost")));
  const json audit = json::parse(run({"audit", path("room.h5"), "--json"}).out)["bands"][0];
  EXPECT_EQ(audit["escaped_W"], 0);
  EXPECT_EQ(audit["absorbed_on_backs_W"], 0);
}

TEST_F(LightWarnings, ARoomWhoseOnlyLampIsOutsideIsNamedDark) {
  folder_.write("dark.json", R"({"format": "reemit-room", "version": 1,
    "materials": {"w": {"reflectance": 0.5}, "l": {"radiance": 10}},
    "objects": [
      {"name": "shell", "material": "w", "box": {"min": [0, 0, 0], "max": [4, 3, 4], "inward": true}},
      {"name": "lamp", "material": "l", "quad": {"corner": [10, 2, 1], "u": [1, 0, 0], "v": [0, 0, 1]}}]})");
  const auto named = AllOf(HasSubstr("no light gets into"), HasSubstr("'shell' (80 m2)"));
  EXPECT_THAT(run(solve("dark.json")).err, named);
  EXPECT_THAT(run({"info", path("room.h5")}).err, named);
}

TEST_F(LightWarnings, UnitsOfGltfAreStatedAndKeptWithTheSolution) {
  std::string room = replaced(small_gltf_room(), R"({"version": "2.0"})",
                              R"({"version": "2.0", "generator": "Khronos glTF Blender I/O v4.2.57"})");
  room = replaced(room, "\"nodes\": [0]", "\"nodes\": [0, 1]");
  room = replaced(
      room, "[{\"mesh\": 0}]",
      R"([{"mesh": 0}, {"translation": [0.5, 0.5, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
      "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": 683}]}})");
  folder_.write("room.gltf", room);
  const auto power_of_lamp = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"info", path("room.gltf"), "--json"});
    const json info = json::parse(run(arguments).out);
    for (const json& luminaire : info["luminaires"])
      if (luminaire["name"] == "bulb") return luminaire["power_W"][0].get<double>();
    return 0.0;
  };
  constexpr double kSphere = 4 * 3.14159265358979323846;
  EXPECT_NEAR(power_of_lamp({}), kSphere, 1e-9);
  EXPECT_NEAR(power_of_lamp({"--gltf-light-efficacy", "100"}), 6.83 * kSphere, 1e-9);

  std::vector<std::string> arguments = solve("room.gltf");
  EXPECT_THAT(run(arguments).err, AllOf(HasSubstr("lamps"), HasSubstr("683 lm/W"), HasSubstr("W/(sr m2)")));
  arguments.insert(arguments.end(), {"--gltf-light-efficacy", "100", "--emissive-units", "cd/m2"});
  EXPECT_THAT(json::parse(run(arguments).out)["notes"],
              AllOf(Contains(HasSubstr("100 lm/W")), Contains(HasSubstr("cd/m2"))));
  // Later commands read the room by the same options: else it would count as another one.
  EXPECT_EQ(json::parse(run({"info", path("room.h5"), "--json"}).out)["room_status"], "unchanged");
}

// A room of colours becomes a spectral one, for every command alike, and says so.
TEST_F(LightWarnings, BandsForARoomOfColours) {
  folder_.write(
      "room.obj",
      "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "usemtl red\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\nusemtl lamp\nf 8 7 6 5\n");
  folder_.write("room.mtl", "newmtl red\nKd 0.6 0.2 0.1\nnewmtl lamp\nKd 0.5 0.5 0.5\nKe 10 8 5\n");
  std::vector<std::string> arguments = solve("room.obj");
  arguments.insert(arguments.end(), {"--bands", "400:700:20"});
  EXPECT_THAT(json::parse(run(arguments).out)["notes"],
              Contains(AllOf(HasSubstr("16 bands, 400:700:20 nm"), HasSubstr("1 : 0.8 : 0.5"))));
  const json solution = json::parse(run({"info", path("room.h5"), "--json"}).out);
  EXPECT_EQ(solution["room_status"], "unchanged");
  EXPECT_EQ(solution["bands"].size(), 16U);
  run({"render", path("room.h5"), "-o", path("view.hdr"), "--eye", "0.5,0.5,0.5", "--look-at", "0.5,0.5,0",
       "--size", "16x16", "--spp", "4"});
  EXPECT_THAT(read_bytes(path("view.hdr")), HasSubstr("equal-energy white shown as D65"));

  for (const char* bands : {"400:700", "400:700:0", "700:400:10", "400:700:x", "400:700:10:1", "0:700:10",
                            "400:700:0.01", "400:405:10", "nan:700:10"}) {
    const ProgramRun refused = run_reemit({"info", path("room.obj"), "--bands", bands});
    EXPECT_EQ(refused.exit_code, 2) << bands;
    EXPECT_THAT(refused.err, AllOf(HasSubstr("--bands"), HasSubstr("400:700:10"))) << bands;
  }
  const ProgramRun resumed = run_reemit({"solve", "--resume", path("room.h5"), "--bands", "400:700:10"});
  EXPECT_THAT(resumed.err, HasSubstr("--bands"));
  EXPECT_EQ(resumed.exit_code, 2);
}

}  // namespace
}  // namespace reemit::test
