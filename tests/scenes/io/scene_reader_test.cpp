#include "scenes/io/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

const std::string kRoom =
    "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nm paint =\nsides 1\nrd 0.5\nf a b c\n";

std::string refusal(const std::filesystem::path& file) {
  try {
    read_scene(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SceneReader, FindsTheReaderByExtensionWhateverItsCase) {
  const test::TempFolder folder;
  const Scene scene = read_scene(folder.write("room.MGF", kRoom));
  EXPECT_EQ(scene.name, "room");
  EXPECT_EQ(scene.bands.kind(), BandKind::kGrey) << "finish_scene has run";
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("no luminaire")));
}

TEST(SceneReader, ForcesTwoSidesWhenAsked) {
  const test::TempFolder folder;
  const auto file = folder.write("room.mgf", kRoom);
  EXPECT_FALSE(read_scene(file).materials.at(0).two_sided);
  EXPECT_TRUE(read_scene(file, {EmissiveUnits::kCandela, true}).materials.at(0).two_sided);
}

TEST(SceneReader, RefusesWhatIsNoRoomFile) {
  const test::TempFolder folder;
  EXPECT_THAT(refusal(folder / "nothing.mgf"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("folder"));
  EXPECT_THAT(refusal(folder.write("empty.json", "")), HasSubstr("empty"));
  EXPECT_THAT(refusal(folder.write("room.xyz", "x")),
              AllOf(HasSubstr("'.xyz'"), HasSubstr(".json .obj .gltf .glb .mgf")));
  EXPECT_THAT(refusal(folder.write("room", "x")), HasSubstr("no extension"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("regular file"));
  EXPECT_THAT(refusal(folder.write("bare.mgf", "# nothing\n")), HasSubstr("no faces"));
}

}  // namespace
}  // namespace reemit
