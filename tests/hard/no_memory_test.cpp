// Rooms and pictures that do not fit into memory: exit code 3, a message, nothing left behind.
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

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(NoMemory, EndsWithCode3) {
#ifdef REEMIT_SANITIZED
  GTEST_SKIP() << "the address sanitizer needs the address space that this test takes away";
#endif
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const std::string solution = solve_small_room(folder, "room.h5").string();
  RunOptions options;
  options.most_memory = 2'000'000'000;
  const std::vector<std::vector<std::string>> commands{
      {"solve", (folder / "room.json").string(), "-o", (folder / "big.h5").string(), "--zone-area", "1e-7"},
      {"render", solution, "--size", "16384x16384", "-o", (folder / "big.exr").string()}};
  for (const std::vector<std::string>& command : commands) {
    const ProgramRun run = run_reemit(command, options);
    EXPECT_EQ(run.exit_code, 3) << command.front() << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr("memory")) << command.front();
    EXPECT_THAT(folder.listing(), ElementsAre("room.h5", "room.json")) << command.front();
  }
}

/// A mesh of one strip of triangles, whose corners are in strip.bin, and `copies` nodes that place it.
std::string instanced_gltf(std::size_t corners, std::size_t copies) {
  const std::string bytes = std::to_string(corners * 3 * sizeof(float));
  std::string file =
      R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "strip.bin", "byteLength": )" + bytes +
      R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" + bytes +
      R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
      std::to_string(corners) +
      R"(}], "meshes": [{"primitives": [{"mode": 5, "attributes": {"POSITION": 0}}]}], "nodes": [)";
  for (std::size_t i = 0; i < copies; ++i) file += i == 0 ? R"({"mesh": 0})" : R"(, {"mesh": 0})";
  return file + "]}";
}

TEST(NoMemory, InstancesThatCannotFitAreRefusedBeforeTheyAreMade) {
#ifdef REEMIT_SANITIZED
  GTEST_SKIP() << "the address sanitizer needs the address space that this test takes away";
#endif
  const TempFolder folder;
  constexpr std::size_t kTriangles = 1900;
  folder.write("room.gltf", instanced_gltf(kTriangles + 2, 5000));
  folder.write("strip.bin", std::string((kTriangles + 2) * 3 * sizeof(float), '\0'));
  RunOptions options;
  options.most_memory = 1'200'000'000;
  const ProgramRun run = run_reemit({"info", (folder / "room.gltf").string()}, options);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("9500000 triangles with all instances: takes at least"));
  EXPECT_THAT(run.err, HasSubstr("GB are free"));
}

TEST(NoMemory, AbsurdlySmallZonesAreRefusedAtOnce) {
  const TempFolder folder;
  folder.write("room.json", small_json_room());
  const ProgramRun run = run_reemit(
      {"solve", (folder / "room.json").string(), "-o", (folder / "big.h5").string(), "--zone-area", "1e-14"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_THAT(run.err, HasSubstr("larger zones"));
  EXPECT_THAT(folder.listing(), ElementsAre("room.json"));
}

}  // namespace
}  // namespace reemit::test
