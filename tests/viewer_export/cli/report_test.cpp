// info --report: what it prints and writes, and what it refuses.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// A lit room with a crate of which the face in line 14 is turned round.
std::string write_room(const TempFolder& folder) {
  folder.write("crate.obj", R"(v 1 1 1
v 2 1 1
v 1 2 1
v 2 2 1
v 1 1 2
v 2 1 2
v 1 2 2
v 2 2 2
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 6 8 4
)");
  return folder
      .write("room.json",
             R"({"format": "reemit-room", "version": 1,
 "materials": {"grey": {"reflectance": 0.5}, "lamp": {"reflectance": 0.5, "radiance": 10}},
 "objects": [
  {"name": "room", "material": "grey", "box": {"min": [0, 0, 0], "max": [4, 4, 4], "inward": true}},
  {"name": "lamp", "material": "lamp", "quad": {"corner": [2, 3.9, 2], "u": [1, 0, 0], "v": [0, 0, 1]}},
  {"name": "crate", "material": "grey", "file": {"path": "crate.obj"}}]})")
      .string();
}

std::vector<std::string> info(const std::string& room, const std::string& report) {
  return {"info", room, "--report", report};
}

TEST(InfoReport, NamesFacesAndSizes) {
  const TempFolder folder;
  const std::string room = write_room(folder);
  const ProgramRun run = run_reemit(info(room, (folder / "report.glb").string()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("1 turned round"), HasSubstr("crate.obj:14, face 5)"),
                             HasSubstr("report.glb"), HasSubstr("smallest [m2]"), HasSubstr("#d4148c")));
  EXPECT_EQ(read_bytes(folder / "report.glb").substr(0, 4), "glTF");
  EXPECT_THAT(folder.listing(), ElementsAre("crate.obj", "report.glb", "room.json"));
  EXPECT_THAT(run_reemit({"info", room}).out, Not(HasSubstr("crate.obj:14"))) << "not asked for";
}

TEST(InfoReport, JsonHasFacesAndSizesWithAndWithoutAPicture) {
  const TempFolder folder;
  const std::string room = write_room(folder);
  const auto plain = nlohmann::json::parse(run_reemit({"info", room, "--json"}).out);
  ASSERT_FALSE(plain["changed_faces"].empty());
  const auto& flipped = plain["changed_faces"][0];
  EXPECT_EQ(flipped["kind"], "flipped");
  EXPECT_EQ(flipped["count"], 1);
  EXPECT_EQ(flipped["first"][0]["line"], 14);
  EXPECT_EQ(flipped["first"][0]["face"], 5);
  EXPECT_THAT(flipped["first"][0]["file"].get<std::string>(), HasSubstr("crate.obj"));
  const auto& cells = plain["zone_sizes"]["cells"];
  EXPECT_LE(cells["smallest_m2"], cells["median_m2"]);
  EXPECT_LE(cells["median_m2"], cells["largest_m2"]);
  std::size_t zones = 0;
  for (const auto& [kind, sizes] : plain["zone_sizes"].items()) zones += sizes["count"].get<std::size_t>();
  EXPECT_EQ(zones, plain["zones_by_default"]);
  EXPECT_FALSE(plain.contains("report"));

  auto arguments = info(room, (folder / "report.glb").string());
  arguments.emplace_back("--json");
  const auto drawn = nlohmann::json::parse(run_reemit(arguments).out);
  EXPECT_EQ(drawn["changed_faces"], plain["changed_faces"]);
  ASSERT_TRUE(drawn.contains("report"));
  std::vector<std::string> kinds;
  for (const auto& object : drawn["report"]["objects"]) kinds.push_back(object["kind"]);
  EXPECT_THAT(kinds, Contains("flipped"));
}

TEST(InfoReport, RefusesWhatCannotBeAReport) {
  const TempFolder folder;
  const std::string room = write_room(folder);
  const auto refused = [&](const std::string& report, const std::string& message) {
    const ProgramRun run = run_reemit(info(room, report));
    EXPECT_EQ(run.exit_code, 2) << report;
    EXPECT_THAT(run.err, HasSubstr(message)) << report;
    EXPECT_EQ(run.out, "") << report;
  };
  refused((folder / "report.ply").string(), "known are .glb");
  refused((folder / "report").string(), "known are .glb");
  std::filesystem::create_directory(folder / "folder.glb");
  refused((folder / "folder.glb").string(), "--report");
  EXPECT_THAT(folder.listing(), ElementsAre("crate.obj", "folder.glb", "room.json"));
}

TEST(InfoReport, FilesOfTheRoomAreNotReplaced) {
  const TempFolder folder;
  const std::string room = write_room(folder);
  const std::string model = (folder / "model.glb").string();
  ASSERT_EQ(run_reemit(info(room, model)).exit_code, 0);
  const std::string before = read_bytes(model);
  EXPECT_EQ(run_reemit(info(model, model)).exit_code, 2) << "a picture is a model, too";
  folder.write("with_model.json", R"({"format": "reemit-room", "version": 1,
 "materials": {"grey": {"reflectance": 0.5}}, "objects": [{"material": "grey", "file": {"path": "model.glb"}}]})");
  const ProgramRun run = run_reemit(info((folder / "with_model.json").string(), model));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("the room is made of"), HasSubstr("--report")));
  EXPECT_EQ(read_bytes(model), before);
}

TEST(InfoReport, SolutionsHaveNone) {
  const TempFolder folder;
  const std::string room = write_room(folder);
  const std::string solution = (folder / "room.h5").string();
  ASSERT_EQ(run_reemit({"solve", room, "-o", solution, "--packets", "1000"}).exit_code, 0);
  const ProgramRun run = run_reemit(info(solution, (folder / "report.glb").string()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("Give the room: reemit info ROOM --report"));
  EXPECT_FALSE(std::filesystem::exists(folder / "report.glb"));
}

}  // namespace
}  // namespace reemit::test
