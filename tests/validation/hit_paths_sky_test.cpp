// Stills under a sky against paths that see it, by its formula, where they leave the room.
#include <string>

#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "tests/support/temp_folder.h"
#include "tests/validation/same_picture.h"

namespace reemit::hit_paths {
namespace {

/// Largest relative error of a reference: 5 of them notice 2 %.
constexpr double kMostSkyError = 0.003;

/// A floor, two walls and a box under a sky; what `more` adds stands on the floor.
Scene court(const test::TempFolder& folder, const std::string& sky, const std::string& more) {
  return read_scene(
      folder.write("court.json", R"({"format": "reemit-room", "version": 1, "name": "court", "bands": "rgb",
 "materials": {"w": {"reflectance": 0.6}, "red": {"reflectance": [0.6, 0.2, 0.1]}, "mirror": {"reflectance": 0, "mirror": 0.8},
               "gloss": {"reflectance": 0.2, "mirror": 0.4, "roughness": 0.3}, "pane": {"reflectance": 0, "glass": {"ior": 1.5}}},
 "objects": [
  {"name": "floor", "material": "w", "quad": {"corner": [-2, -2, 0], "u": [4, 0, 0], "v": [0, 4, 0]}},
  {"name": "wall", "material": "red", "quad": {"corner": [-2, 2, 0], "u": [4, 0, 0], "v": [0, 0, 2]}},
  {"name": "side", "material": "w", "quad": {"corner": [-2, -2, 0], "u": [0, 4, 0], "v": [0, 0, 2]}},
  {"name": "block", "material": "w", "box": {"min": [0, 0, 0], "max": [0.8, 0.8, 1], "open": ["z-"]}})" +
                                     more + R"(],
 "sky": )" + sky + R"(,
 "cameras": [{"name": "c", "eye": [3, -3, 2.2], "look_at": [-0.5, 0.8, 0.7], "up": [0, 0, 1], "vertical_fov_deg": 50}]})"));
}

TEST(HitPathsUnderASky, clear_with_its_sun) {
  const test::TempFolder folder;
  const Scene scene =
      court(folder,
            R"({"type": "clear", "irradiance": [60, 80, 120], "up": "z", "ground_reflectance": 0.25,
      "sun": {"altitude_deg": 35, "azimuth_deg": 200, "irradiance": [500, 450, 380], "angle_deg": 3}})",
            "");
  expect_same_picture(scene, scene.sky->description, kMostSkyError);
}

TEST(HitPathsUnderASky, overcast_over_mirrors_gloss_and_through_panes) {
  const test::TempFolder folder;
  const Scene scene = court(folder, R"({"type": "overcast", "irradiance": [100, 110, 130], "up": "z"})", R"(,
  {"name": "mirror", "material": "mirror", "quad": {"corner": [-1.9, -1.2, 0.2], "u": [0, 1.4, 0], "v": [0, 0, 1.4]}},
  {"name": "plate", "material": "gloss", "quad": {"corner": [-1.5, -1.8, 0.02], "u": [2.4, 0, 0], "v": [0, 1.2, 0]}},
  {"name": "pane", "material": "pane", "quad": {"corner": [0.9, -1.5, 0.05], "u": [0, 1.5, 0], "v": [0, 0, 1.2]}})");
  expect_same_picture(scene, scene.sky->description, kMostSkyError);
}

}  // namespace
}  // namespace reemit::hit_paths
