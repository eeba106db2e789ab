// Stills against paths that sample no luminaire and share neither mesh nor rays with the program, in short:
// the long form is bench_hit_paths.
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/block_reference.h"
#include "bench/hit_paths/photometry_file.h"
#include "bench/hit_paths/touching_lamps.h"
#include "scenes/io/photometry/ies_reader.h"
#include "scenes/io/scene_reader.h"
#include "tests/support/temp_folder.h"
#include "tests/validation/same_picture.h"

namespace reemit::hit_paths {
namespace {

/// Largest relative error of a reference.
constexpr double kMostError = 0.01;

/// A lamp that hangs over a wall, and a plinth whose edge runs along it 4 micrometres inside its ends.
Scene lamp_with_plinth(const test::TempFolder& folder) {
  folder.write("room.json",
               R"({"format": "reemit-room", "version": 1, "name": "lamp with plinth", "bands": "grey",
 "materials": {"w": {"reflectance": 0.5}, "lamp": {"reflectance": 0, "radiance": 3.59}},
 "objects": [
  {"name": "lamp", "material": "lamp", "polygon": {"vertices": [[-5.62738, 5.07771, 3.443749],
     [0.8356, 5.07771, 3.443749], [0.8356, -0.04149, 3.443751], [-5.62738, -0.04149, 3.443751]]}},
  {"name": "wall", "material": "w", "quad": {"corner": [-12, -1, -3], "u": [14, 0, 0], "v": [0, 8, 0]}},
  {"name": "plinth", "material": "w",
   "quad": {"corner": [-5.627376, 0.025222, 2.998156], "u": [0, 0, 0.445595], "v": [6.462972, 0, 0]}}],
 "cameras": [{"name": "c", "eye": [-5, 2.5, 3], "look_at": [-5, 2.5, -3], "vertical_fov_deg": 70}]})");
  return read_scene(folder / "room.json");
}

TEST(HitPaths, a_plinth_along_a_lamp_does_not_put_it_out_and_a_bias_is_noticed) {
  const test::TempFolder folder;
  const Scene scene = lamp_with_plinth(folder);
  ComparisonSettings settings = quick(false);
  const std::vector<BlockSums> reference = trace_reference(scene, scene.cameras[0], settings);
  expect_same_picture(scene, scene.name, kMostError, reference);
  settings.planted_bias = 0.02;
  const Comparison biased = compare_blocks(scene, scene.cameras[0], settings, reference);
  EXPECT_GT(std::abs(biased.mean_deviation), kPictureLimit * biased.mean_error)
      << biased.mean_deviation << " +- " << biased.mean_error;
}

TEST(HitPaths, lamps_may_touch_what_is_around_them) {
  const Scene scene = touching_lamps_room(107);
  expect_same_picture(scene, scene.name, kMostError);
}

const std::filesystem::path kRooms = std::filesystem::path(REEMIT_SOURCE_DIR) / "bench/hit_paths/rooms";

/// The reference reads the files itself and turns directions into angles in its own way.
TEST(HitPaths, intensities_of_files_are_those_of_the_tables) {
  const std::filesystem::path source = REEMIT_SOURCE_DIR;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const auto& file :
       {kRooms / "troffer.ies", kRooms / "pendant.ies", kRooms / "drum.ies", kRooms / "globe.ies",
        source / "bench/validation/luminaires/planes.ies", source / "bench/validation/luminaires/axial.ies",
        source / "docs/examples/downlight.ies"}) {
    const MeasuredLuminaire luminaire = read_ies_file(file);
    const Photometry read_anew(file);
    const Photometry from_table(*luminaire.table);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 direction(normal(random), normal(random), normal(random));
      const double expected = luminaire.table->intensity(direction);
      EXPECT_NEAR(read_anew.candela(direction), expected, 1e-6 * luminaire.table->greatest_intensity())
          << file << " " << direction.transpose();
      EXPECT_NEAR(from_table.candela(direction), expected, 1e-6 * luminaire.table->greatest_intensity())
          << file << " " << direction.transpose();
    }
  }
}

TEST(HitPaths, openings_of_measured_luminaires_of_every_shape_light_the_room) {
  const Scene scene = read_scene(kRooms / "measured_luminaires.json");
  expect_same_picture(scene, scene.name, kMostError);
}

}  // namespace
}  // namespace reemit::hit_paths
