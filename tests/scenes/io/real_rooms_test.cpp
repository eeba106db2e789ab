// Rooms made by others, read where a checkout of them lies in shared/scenes beside the sources; skipped
// elsewhere.
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/mgf/mgf_reader.h"
#include "scenes/io/obj/obj_reader.h"
#include "tests/scenes/io/face_area.h"

namespace reemit {
namespace {

namespace fs = std::filesystem;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

fs::path shared_scenes() {
  for (fs::path folder = REEMIT_SOURCE_DIR; folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder.parent_path() / "shared/scenes")) return folder.parent_path() / "shared/scenes";
  return {};
}

class RealRooms : public ::testing::Test {
 protected:
  void SetUp() override {
    if (shared_scenes().empty()) GTEST_SKIP() << "no folder shared/scenes beside the sources";
  }
  static Scene mgf(const std::string& name) {
    Scene scene = read_mgf_scene(shared_scenes() / "mgf" / name, {});
    finish_scene(scene);
    return scene;
  }
  static Scene obj(const std::string& name) {
    Scene scene = read_obj_scene(shared_scenes() / "obj" / name, {});
    finish_scene(scene);
    return scene;
  }
};

TEST_F(RealRooms, FurnaceBoxHasItsStatedRadiance) {
  const Scene scene = mgf("erw5/scene0.mgf");
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.bands.kind(), BandKind::kGrey);
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_FALSE(scene.materials[0].two_sided);
  EXPECT_FALSE(scene.materials[0].emits_both_sides);
  const double luminance = 179 * scene.materials[0].emitted_radiance[0];
  EXPECT_NEAR(luminance, 140.59 / std::numbers::pi, 1e-12);
  EXPECT_EQ(scene.materials[0].reflectance[0], 0.5);
  EXPECT_EQ(test::face_count(scene), 6U);
  EXPECT_NEAR(test::total_area(scene), 2 * 36 + 4 * 18, 1e-12);
  const Vec3 centre = bounds(scene).centre();
  for (const Surface& s : scene.surfaces)
    for (const Face& f : s.faces)
      EXPECT_GT(test::area_vector(s, f).dot(centre - s.positions[f.outer[0]]), 0) << "all look inwards";
}

TEST_F(RealRooms, WorkshopLampsHaveTheRadianceOfTheirDescription) {
  for (const auto& [name, radiance] : std::vector<std::pair<std::string, double>>{
           {"scene1", 0.5}, {"scene3", 18}, {"scene4", 1800}, {"scene5", 18}, {"scene6", 18}}) {
    const Scene scene = mgf("erw5/" + name + ".mgf");
    int lamps = 0;
    for (const Material& m : scene.materials) {
      if (!m.emits()) continue;
      ++lamps;
      EXPECT_NEAR(m.emitted_radiance[0], radiance, 1e-4 * radiance) << name;
    }
    EXPECT_EQ(lamps, 1) << name;
    EXPECT_EQ(bounds(scene).size(), Vec3(6, 3, 6)) << name;
  }
}

TEST_F(RealRooms, ConferenceRoomComesInMetresWithItsVentsAndHoles) {
  const Scene scene = mgf("conference_1994/conf.mgf");
  EXPECT_TRUE(bounds(scene).size().isApprox(Vec3(11.15, 7.17, 2.71), 1e-3));
  EXPECT_EQ(scene.bands.kind(), BandKind::kRgb);
  std::size_t holes = 0, vents = 0;
  for (const Surface& s : scene.surfaces) {
    if (s.source.ends_with("vent.mgf")) vents += s.faces.size();
    for (const Face& f : s.faces) holes += f.holes.size();
  }
  EXPECT_EQ(vents, 18U * 309) << "eighteen includes";
  EXPECT_GE(holes, 18U);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(RealRooms, CorridorHasItsStripLamps) {
  const Scene scene = mgf("corridor/corridor.mgf");
  EXPECT_TRUE(bounds(scene).size().isApprox(Vec3(20, 20, 10)));
  double lamps = 0;
  for (const Surface& s : scene.surfaces)
    if (scene.material_of(s).emits())
      for (const Face& f : s.faces) lamps += test::area_vector(s, f).norm();
  EXPECT_NEAR(lamps, (19 + 10 + 18 + 10) * 0.16, 1e-9);
}

TEST_F(RealRooms, CornellVariantsRead) {
  for (const auto& entry : fs::directory_iterator(shared_scenes() / "obj/cornell")) {
    if (entry.path().extension() != ".obj") continue;
    const Scene scene = obj("cornell/" + entry.path().filename().string());
    EXPECT_GE(scene.surfaces.size(), 6U) << entry.path();
    EXPECT_NEAR(bounds(scene).size().x(), 2.02, 1e-9) << entry.path();
    EXPECT_THAT(scene.warnings, Each(HasSubstr("more than 1 in 2 material(s): 'sphere', 'floor'")))
        << entry.path();
  }
}

TEST_F(RealRooms, ModernHallHasItsLampsTexturesAndCamera) {
  const Scene scene = obj("modern_hall/modern_hall.obj");
  EXPECT_EQ(test::face_count(scene), 28495U) << "30,924 less those without three different corners";
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_NEAR(scene.cameras[0].vertical_fov_deg, 42.9957, 1e-3);
  int lamps = 0, textures = 0;
  for (const Material& m : scene.materials) lamps += m.emits();
  for (const Material& m : scene.materials) textures += m.textures.reflectance ? 1 : 0;
  EXPECT_EQ(lamps, 13);
  EXPECT_EQ(textures, 3);
}

}  // namespace
}  // namespace reemit
