// Rooms that cannot be right: every one ends with exit code 2, a message that says what and where, and no
// output.
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/solution/file_seal.h"
#include "tests/support/csv_file.h"
#include "tests/support/run_program.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Ends as solutions do; other files would not be replaced in any case.
const std::string kOldSolution = "what was here before" + seal_of("what was here before");

/// Solves `room`; it must be refused with a message that holds every one of `words`, and an existing output
/// must stay as it was.
void expect_refused(const TempFolder& folder, const std::string& room,
                    const std::vector<std::string>& words) {
  const auto output = folder.write("old.h5", kOldSolution);
  const std::vector<std::string> before = folder.listing();
  const ProgramRun run =
      run_reemit({"solve", (folder / room).string(), "-o", output.string(), "--packets", "1000"});
  EXPECT_EQ(run.exit_code, 2) << room << ": " << run.err;
  EXPECT_THAT(run.out, IsEmpty()) << room;
  EXPECT_THAT(run.err, HasSubstr("reemit: error: ")) << room;
  for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word)) << room;
  EXPECT_TRUE(read_bytes(output) == kOldSolution) << room << ": the output was overwritten";
  EXPECT_EQ(folder.listing(), before) << room << ": something was left behind";
}

/// The small room with one light.
std::string with_light(const std::string& light) {
  return replaced(small_json_room(), "\"cameras\"", "\"lights\": [" + light + "],\n  \"cameras\"");
}

TEST(BadRooms, MissingFile) {
  for (const char* name : {"none.json", "none.obj", "none.gltf", "none.glb", "none.mgf"}) {
    const TempFolder folder;
    expect_refused(folder, name, {name});
  }
}

TEST(BadRooms, UnknownExtensionListsTheKnownOnes) {
  const TempFolder folder;
  folder.write("room.3ds", "x");
  expect_refused(folder, "room.3ds", {"room.3ds", ".json", ".mgf"});
}

TEST(BadRooms, FolderInsteadOfAFile) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "room.json");
  expect_refused(folder, "room.json", {"room.json"});
}

TEST(BadRooms, EmptyFile) {
  for (const char* name : {"room.json", "room.obj", "room.gltf", "room.glb", "room.mgf"}) {
    const TempFolder folder;
    folder.write(name, "");
    expect_refused(folder, name, {name});
  }
}

TEST(BadRooms, TruncatedJson) {
  const std::string whole = small_json_room();
  for (const std::size_t size : {whole.size() / 4, whole.size() / 2, whole.size() - 3}) {
    const TempFolder folder;
    folder.write("room.json", whole.substr(0, size));
    expect_refused(folder, "room.json", {"room.json"});
  }
}

TEST(BadRooms, TruncatedObj) {
  // Cut in the middle of a number list, and after the faces' material but before its library is there.
  const TempFolder folder;
  folder.write("room.mtl", small_obj_materials());
  folder.write("room.obj", "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl white\nf 1 2");
  expect_refused(folder, "room.obj", {"room.obj"});
  folder.write("room.obj", "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1");
  expect_refused(folder, "room.obj", {"room.obj"});
}

TEST(BadRooms, TruncatedMgf) {
  const std::string whole = small_mgf_room();
  const TempFolder folder;
  folder.write("room.mgf", whole.substr(0, whole.find("v c") + 8));  // in the middle of a point
  expect_refused(folder, "room.mgf", {"room.mgf"});
  folder.write("room.mgf", whole.substr(0, whole.find("m lamp\no")) + "f a b");  // in the middle of a face
  expect_refused(folder, "room.mgf", {"room.mgf"});
}

TEST(BadRooms, TruncatedGltf) {
  const std::string whole = small_gltf_room();
  for (const std::size_t size : {whole.size() / 3, whole.size() - 4}) {
    const TempFolder folder;
    folder.write("room.gltf", whole.substr(0, size));
    expect_refused(folder, "room.gltf", {"room.gltf"});
  }
}

TEST(BadRooms, TruncatedGlb) {
  const std::string whole = small_glb_room();
  for (const std::size_t size : {std::size_t{3}, std::size_t{12}, std::size_t{40}, whole.size() - 8}) {
    const TempFolder folder;
    folder.write("room.glb", whole.substr(0, size));
    expect_refused(folder, "room.glb", {"room.glb"});
  }
}

TEST(BadRooms, CoordinatesThatAreNoNumbers) {
  const TempFolder folder;
  folder.write("room.json", replaced(small_json_room(), "[0.4, 0.98, 0.4]", "[0.4, NaN, 0.4]"));
  expect_refused(folder, "room.json", {"room.json"});
  folder.write("room.json", replaced(small_json_room(), "[0.4, 0.98, 0.4]", "[0.4, 1e999, 0.4]"));
  expect_refused(folder, "room.json", {"room.json"});
  folder.write("room.json", replaced(small_json_room(), "[0.4, 0.98, 0.4]", "[0.4, \"high\", 0.4]"));
  expect_refused(folder, "room.json", {"room.json", "/objects/1/quad/corner"});
  folder.write("room.mtl", small_obj_materials());
  for (const char* bad : {"nan", "inf", "-inf", "1e999"}) {
    folder.write("room.obj", replaced(small_obj_room(), "v 1 1 1", std::string("v 1 ") + bad + " 1"));
    expect_refused(folder, "room.obj", {"room.obj"});
    folder.write("room.mgf", replaced(small_mgf_room(), "p 1 1 1", std::string("p 1 ") + bad + " 1"));
    expect_refused(folder, "room.mgf", {"room.mgf"});
  }
}

TEST(BadRooms, NotFiniteCoordinatesInBinaryGltf) {
  const TempFolder folder;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    folder.write("room.glb", small_glb_room(bad));
    expect_refused(folder, "room.glb", {"room.glb"});
  }
}

TEST(BadRooms, IndexOutOfRange) {
  const TempFolder folder;
  folder.write("room.mtl", small_obj_materials());
  folder.write("room.obj", replaced(small_obj_room(), "f 5 6 7 8", "f 5 6 7 99"));
  expect_refused(folder, "room.obj", {"room.obj"});
  folder.write("room.obj", replaced(small_obj_room(), "f 5 6 7 8", "f -5 -6 -7 -99"));
  expect_refused(folder, "room.obj", {"room.obj"});
  folder.write("room.obj", replaced(small_obj_room(), "f 5 6 7 8", "f 0 6 7 8"));
  expect_refused(folder, "room.obj", {"room.obj"});
  folder.write("room.mgf", replaced(small_mgf_room(), "f h g f e", "f h g nowhere e"));
  expect_refused(folder, "room.mgf", {"room.mgf", "nowhere"});
  folder.write(
      "room.json",
      R"({"format": "reemit-room", "version": 1, "materials": {"white": {"reflectance": 0.5}}, "objects":
               [{"material": "white", "mesh": {"vertices": [[0,0,0],[1,0,0],[0,1,0]], "faces": [[0,1,3]]}}]})");
  expect_refused(folder, "room.json", {"room.json", "/objects/0/mesh/faces/0"});
  folder.write("room.gltf", replaced(small_gltf_room(), "\"indices\": 1", "\"indices\": 17"));
  expect_refused(folder, "room.gltf", {"room.gltf"});
  folder.write("room.glb", small_glb_room(0.0F, 60000));
  expect_refused(folder, "room.glb", {"room.glb"});
}

TEST(BadRooms, ReflectanceOutOfRange) {
  const TempFolder folder;
  // A Kd a little above 1 is what some programs write for 1; that is read, with a warning.
  for (const auto& [bad, bad_kd] : {std::pair{"1.5", "150"}, std::pair{"-0.1", "-0.1"}}) {
    folder.write("room.json", replaced(small_json_room(), "\"white\": {\"reflectance\": 0.5}",
                                       std::string("\"white\": {\"reflectance\": ") + bad + "}"));
    expect_refused(folder, "room.json", {"room.json", "/materials/white/reflectance"});
    folder.write("room.mgf", replaced(small_mgf_room(), "rd 0.5", std::string("rd ") + bad));
    expect_refused(folder, "room.mgf", {"room.mgf"});
    folder.write("room.mtl",
                 replaced(small_obj_materials(), "Kd 0.5 0.5 0.5", std::string("Kd 0.5 ") + bad_kd + " 0.5"));
    folder.write("room.obj", small_obj_room());
    expect_refused(folder, "room.obj", {"room.mtl:2", "Kd"});
  }
}

TEST(BadRooms, UnknownMaterial) {
  const TempFolder folder;
  folder.write("room.json", replaced(small_json_room(), "\"name\": \"lamp\", \"material\": \"lamp\"",
                                     "\"name\": \"lamp\", \"material\": \"lmap\""));
  expect_refused(folder, "room.json", {"/objects/1/material", "lmap", "lamp"});
  folder.write("room.mgf", replaced(small_mgf_room(), "m lamp\no", "m lmap\no"));
  expect_refused(folder, "room.mgf", {"room.mgf", "lmap"});
}

TEST(BadRooms, MisspeltKey) {
  const TempFolder folder;
  folder.write("room.json", replaced(small_json_room(), "\"exitance\"", "\"exitence\""));
  expect_refused(folder, "room.json", {"room.json", "/materials/lamp", "exitence", "exitance"});
}

TEST(BadRooms, UnknownMgfEntityIsWarnedOf) {
  // The format asks its readers to skip what they do not know.
  const TempFolder folder;
  folder.write("room.mgf", replaced(small_mgf_room(), "\trd 0.5", "\trdd 0.5"));
  const ProgramRun run = run_reemit(
      {"solve", (folder / "room.mgf").string(), "-o", (folder / "room.h5").string(), "--packets", "1000"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning"));
  EXPECT_THAT(run.err, HasSubstr("rdd"));
}

TEST(BadRooms, MgfThatIncludesItself) {
  const TempFolder folder;
  folder.write("room.mgf", "i part.mgf\n");
  folder.write("part.mgf", "i room.mgf\n");
  expect_refused(folder, "room.mgf", {".mgf", "include"});
}

TEST(BadRooms, GltfNodesInACircle) {
  const TempFolder folder;
  folder.write("room.gltf", replaced(small_gltf_room(), "\"nodes\": [{\"mesh\": 0}]",
                                     "\"nodes\": [{\"mesh\": 0, \"children\": [1]}, {\"children\": [0]}]"));
  expect_refused(folder, "room.gltf", {"room.gltf", "node"});
}

TEST(BadRooms, JsonGroupThatContainsItself) {
  const TempFolder folder;
  folder.write("room.json",
               R"({"format": "reemit-room", "version": 1, "materials": {"white": {"reflectance": 0.5}},
               "groups": {"a": [{"group": "b"}], "b": [{"group": "a"}]},
               "objects": [{"group": "a", "material": "white"}]})");
  expect_refused(folder, "room.json", {"room.json", "contains itself"});
}

TEST(BadRooms, NothingToTrace) {
  const TempFolder folder;
  folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {}, "objects": []})");
  expect_refused(folder, "room.json", {"room.json"});
}

TEST(BadRooms, EmissionOfNothing) {
  const TempFolder folder;
  folder.write("room.json", replaced(small_json_room(), "[30, 25, 20]", "[0, 0, 0]"));
  expect_refused(folder, "room.json", {"#/materials/lamp/exitance", "emits nothing"});
  folder.write("room.json", with_light(R"({"type": "point", "position": [0.5, 0.5, 0.5], "flux_lm": 0})"));
  expect_refused(folder, "room.json", {"#/lights/0/flux_lm", "emits nothing", "Remove it or give it power"});
  folder.write("room.json",
               with_light(R"({"type": "directional", "direction": [0, -1, 0], "irradiance": [0, 0, 0]})"));
  expect_refused(folder, "room.json", {"#/lights/0/irradiance", "emits nothing"});
}

TEST(BadRooms, BrokenPhotometricFiles) {
  const std::string good =
      "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 80 0\n";
  const std::string room = with_light(R"({"type": "ies", "file": "lamp.ies", "position": [0.5, 0.9, 0.5]})");
  const TempFolder folder;
  folder.write("room.json", room);
  folder.write("lamp.ies", replaced(good, "100 80 0", "100 80"));
  expect_refused(folder, "room.json", {"#/lights/0/file", "lamp.ies:7", "number 3 of 3 candela values"});
  folder.write("lamp.ies", replaced(good, "0 45 90", "0 90 45"));
  expect_refused(folder, "room.json", {"lamp.ies:5", "do not increase"});
  folder.write("lamp.ies", replaced(good, "1 -1 1 3 1", "1 -1 1 2000000000 1"));
  expect_refused(folder, "room.json", {"lamp.ies:3", "vertical angles"});
  folder.write("lamp.ies", replaced(good, "100 80 0", "0 0 0"));
  expect_refused(folder, "room.json", {"lamp.ies:7", "gives no light"});
  folder.write("lamp.ies", good);
  const ProgramRun run = run_reemit(
      {"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string(), "--packets", "1000"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(BadRooms, ALampTooSmallOrThinToMeshIsRefused) {
  const std::string lamp = R"("quad": {"corner": [0.4, 0.98, 0.4], "u": [0.2, 0, 0], "v": [0, 0, 0.2]})";
  for (const char* outline :
       {R"("quad": {"corner": [0.4, 0.9, 0.4], "u": [1e-10, 0, 0], "v": [0, 0, 1e-10]})",
        R"("polygon": {"vertices": [[0.2, 0.9, 0.2], [0.8, 0.9, 0.2], [0.5, 0.9, 0.20000001]]})"}) {
    const TempFolder folder;
    folder.write("room.json", replaced(small_json_room(), lamp, outline));
    expect_refused(folder, "room.json", {"luminaire 'lamp'", "room.json, face 0", "smaller or thinner"});
  }
}

TEST(BadRooms, NoLuminaireIsBlackAndWarned) {
  const TempFolder folder;
  folder.write("room.json", replaced(small_json_room(), R"(, "exitance": [30, 25, 20])", ""));
  const ProgramRun run = run_reemit(
      {"solve", (folder / "room.json").string(), "-o", (folder / "room.h5").string(), "--packets", "1000"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning"));
  EXPECT_THAT(run.err, HasSubstr("luminaire"));
  EXPECT_THAT(run.out, HasSubstr("no luminaire"));
  const ProgramRun picture = run_reemit(
      {"export", (folder / "room.h5").string(), "-o", (folder / "room.csv").string(), "--values", "zones"});
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
  EXPECT_GT(csv_rows(folder / "room.csv").size(), 8U);
  for (const CsvRow& row : csv_rows(folder / "room.csv")) {
    for (const char* column : {"radiance_r", "radiance_g", "radiance_b", "irradiance_r", "direct_r"}) {
      EXPECT_EQ(row.at(column), "0") << column;
    }
  }
}

}  // namespace
}  // namespace reemit::test
