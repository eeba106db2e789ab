#include "solver/solution/room_of_solution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/error.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class RoomOfSolution : public testing::Test {
 protected:
  RoomOfSolution() {
    const auto room = folder_.write("room.json", test::small_json_room());
    std::filesystem::create_directory(folder_ / "moved");
    const Scene scene = read_scene(room);
    solution_.room_path = room.string();
    solution_.room_hash = content_hash(scene);
    solution_.bands = scene.bands;
    keep_surfaces(scene, solution_);
    solution_.mesh = build_mesh(scene).mesh;
  }

  test::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "moved/room.solution";
  Solution solution_;
};

TEST_F(RoomOfSolution, IsFoundWhereItWasSolved) {
  EXPECT_EQ(content_hash(read_room_of(solution_, file_)), solution_.room_hash);
}

TEST_F(RoomOfSolution, IsFoundBesideTheSolution) {
  std::filesystem::rename(folder_ / "room.json", folder_ / "moved/room.json");
  EXPECT_EQ(read_room_of(solution_, file_).source, (folder_ / "moved/room.json").string());
}

TEST_F(RoomOfSolution, IsTakenFromWhereTheUserSays) {
  std::filesystem::rename(folder_ / "room.json", folder_ / "other.json");
  EXPECT_EQ(read_room_of(solution_, file_, {folder_ / "other.json"}).surfaces.size(),
            solution_.surface_names.size());
  EXPECT_THAT([&] { read_room_of(solution_, file_, {folder_ / "none.json"}); },
              ThrowsMessage<InputError>(HasSubstr("there is no such file")));
}

TEST_F(RoomOfSolution, OfSeveralFilesIsFoundBesideTheSolutionOrByTheirNames) {
  const std::vector<std::filesystem::path> files = {
      folder_.write("materials.mgf", "m paint =\nrd 0.25\n"),
      folder_.write("room.mgf", "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nm paint\nf a b c\n")};
  const Scene scene = read_scene(files);
  solution_.room_path = files[0].string();
  solution_.more_room_paths = {files[1].string()};
  solution_.room_hash = content_hash(scene);
  solution_.bands = scene.bands;
  keep_surfaces(scene, solution_);
  solution_.mesh = build_mesh(scene).mesh;
  EXPECT_EQ(read_room_of(solution_, file_).surfaces.size(), 1U);
  std::filesystem::rename(files[1], folder_ / "moved/room.mgf");
  EXPECT_THAT(read_room_of(solution_, file_).source, HasSubstr("moved/room.mgf"));
  std::filesystem::rename(folder_ / "moved/room.mgf", folder_ / "other.mgf");
  EXPECT_THAT([&] { read_room_of(solution_, file_); }, ThrowsMessage<InputError>(HasSubstr("room.mgf")));
  EXPECT_THAT(read_room_of(solution_, file_, {files[0], folder_ / "other.mgf"}).source,
              HasSubstr("other.mgf"));
}

TEST_F(RoomOfSolution, IsMissedWithAdvice) {
  std::filesystem::remove(folder_ / "room.json");
  EXPECT_THAT([&] { read_room_of(solution_, file_); }, ThrowsMessage<InputError>(HasSubstr("--room")));
}

TEST_F(RoomOfSolution, IsRefusedWhenItHasChanged) {
  std::string text = test::small_json_room();
  text.replace(text.find("\"reflectance\": 0.5"), 18, "\"reflectance\": 0.4");
  folder_.write("room.json", text);
  EXPECT_THAT([&] { read_room_of(solution_, file_); }, ThrowsMessage<InputError>(HasSubstr("has changed")));
}

TEST_F(RoomOfSolution, IsRefusedWhenZonesPointOutsideOfIt) {
  BaseMesh base = solution_.mesh.base();
  base.triangles.front().face = 1000;
  solution_.mesh = ZoneMesh(base);
  EXPECT_THAT([&] { read_room_of(solution_, file_); }, ThrowsMessage<InputError>(HasSubstr("is damaged")));
}

}  // namespace
}  // namespace reemit
