#include "scenes/io/scene_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kRoom =
    "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nm paint =\nsides 1\nrd 0.5\nf a b c\n";

std::string refusal(const std::filesystem::path& file) {
  return test::refusal_of([&] { read_scene(file); });
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
  ReadOptions options;
  options.force_two_sided = true;
  EXPECT_TRUE(read_scene(file, options).materials.at(0).two_sided);
}

TEST(SceneReader, SeveralMgfFilesAreOneRoom) {
  const test::TempFolder folder;
  const std::vector<std::filesystem::path> files = {
      folder.write("materials.mgf", "m paint =\nrd 0.25\nv a =\np 0 0 0\nxf -t 0 0 9\n"),
      folder.write("room.mgf", "v b =\np 1 0 0\nv c =\np 1 1 0\nm paint\nf a b c\n"),
      folder.write("lamps.mgf", "m lamp =\ned 100\nf a b c\n")};
  const Scene scene = read_scene(files);
  ASSERT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.material_of(scene.surfaces[0]).reflectance[0], 0.25);
  EXPECT_EQ(bounds(scene).max.z(), 0) << "transforms end with their file";
  EXPECT_EQ(scene.name, "materials+room+lamps");
  EXPECT_THAT(scene.source, AllOf(HasSubstr("materials.mgf + "), HasSubstr("lamps.mgf")));
  const std::string whole =
      test::read_bytes(files[0]) + "xf\n" + test::read_bytes(files[1]) + test::read_bytes(files[2]);
  EXPECT_EQ(content_hash(scene), content_hash(read_scene(folder.write("whole.mgf", whole))));

  for (const std::vector<std::filesystem::path>& mixed :
       {std::vector{files[1], folder.write("chair.obj", "x")},
        std::vector{folder.write("a.json", "x"), files[1]}})
    EXPECT_THAT(test::refusal_of([&] { read_scene(mixed); }),
                AllOf(HasSubstr("only MGF files can"), HasSubstr("JSON room")));
}

TEST(SceneReader, NamesAllFilesThatARoomIsMadeOf) {
  const test::TempFolder folder;
  folder.write("paint.mtl", "newmtl paint\nKd 0.5 0.5 0.5\n");
  folder.write("chair.obj", "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl paint\nf 1 2 3\n");
  const auto native = folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {},
 "objects": [{"file": {"path": "chair.obj"}}, {"file": {"path": "chair.obj"}, "transform": [{"translate": [2, 0, 0]}]}]})");
  folder.write("triangle.mgf", kRoom);
  const auto mgf = folder.write("room.mgf", "i triangle.mgf\n");
  const auto names = [&](const std::filesystem::path& file) {
    std::vector<std::string> found;
    for (const std::string& name : read_scene(file).files) {
      EXPECT_TRUE(std::filesystem::path(name).is_absolute()) << name;
      found.push_back(std::filesystem::path(name).filename().string());
    }
    return found;
  };
  EXPECT_THAT(names(native), ElementsAre("room.json", "chair.obj", "paint.mtl"));
  EXPECT_THAT(names(mgf), ElementsAre("room.mgf", "triangle.mgf"));
}

TEST(SceneReader, RefusesWhatIsNoRoomFile) {
  const test::TempFolder folder;
  EXPECT_THAT(refusal(folder / "nothing.mgf"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("folder"));
  EXPECT_THAT(refusal(folder.write("empty.json", "")), HasSubstr("empty"));
  EXPECT_THAT(refusal(folder.write("room.xyz", "x")),
              AllOf(HasSubstr("'.xyz'"), HasSubstr(".json .obj .gltf .glb .mgf")));
  EXPECT_THAT(refusal(folder.write("room", "x")), HasSubstr("no extension"));
  EXPECT_THAT(refusal(folder.write("lamp.ies", "x")), HasSubstr("a light of a JSON room"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("regular file"));
  EXPECT_THAT(refusal(folder.write("bare.mgf", "# nothing\n")), HasSubstr("no faces"));
}

}  // namespace
}  // namespace reemit
