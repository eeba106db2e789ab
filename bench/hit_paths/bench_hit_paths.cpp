// Stills, block by block, against paths that sample no luminaire, on generated rooms and rooms of one's own.
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/touching_lamps.h"
#include "bench/program_options.h"
#include "scenes/io/scene_reader.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/default_cameras.h"

namespace {

using namespace reemit;
using namespace reemit::hit_paths;

/// Median standard error of blocks above which a picture of the reference says nothing: light came to single
/// paths only.
constexpr double kMostReferenceError = 0.5;

void print(const std::string& room, const Comparison& c) {
  double largest = 0;
  for (const BlockDeviation& b : c.blocks)
    if (std::abs(b.errors()) > kMostErrors) largest = std::max(largest, std::abs(b.relative()));
  fmt::print("| {} | {} | {} | {:.2f} / {:.2f} | {:.1f} | {:+.2f} +- {:.2f} | {:.1f} | {:.1f} | {} |\n", room,
             c.camera, c.blocks.size(), 100 * c.reference_error, 100 * c.largest_reference_error,
             1e-6 * static_cast<double>(c.paths), 100 * c.mean_deviation, 100 * c.mean_error,
             c.blocks.empty() ? 0.0 : std::abs(c.blocks[0].errors()), 100 * largest, c.different());
  std::size_t shown = 0;
  for (const BlockDeviation& b : c.blocks)
    if (b.differs() && shown++ < 8)
      fmt::print(
          "<!-- block at pixel ({}, {}): {:.4g} against {:.4g}, {:+.1f} %, {:+.1f} standard errors -->\n",
          b.x, b.y, b.checked, b.reference, 100 * b.relative(), b.errors());
  std::fflush(stdout);
}

/// Which cameras of a room are compared.
struct CameraChoice {
  std::size_t most = 1;
  std::string name;  ///< The one of that name, if it is not empty.
};

std::vector<Camera> cameras_of(const Scene& scene, const CameraChoice& choice) {
  std::vector<Camera> cameras = scene.cameras;
  if (cameras.empty()) {
    const ZoneMesh mesh = build_zones(scene).mesh;
    cameras = default_cameras(Room(scene, mesh));
  }
  if (!choice.name.empty()) {
    std::erase_if(cameras, [&](const Camera& c) { return c.name != choice.name; });
    if (cameras.empty()) throw std::runtime_error("the room has no camera " + choice.name);
  }
  cameras.resize(std::min(cameras.size(), choice.most));
  return cameras;
}

/// What the reference does not know. Stills are shaded with normals of the file, which turn what is seen in
/// mirrors; the reference has those of the polygons. Images on surfaces count with their means.
void drop_details(Scene& scene) {
  for (Surface& surface : scene.surfaces) {
    surface.normals.clear();
    surface.texture_points.clear();
    surface.has_vertex_colours = false;
    for (Face& face : surface.faces) {
      face.normals.clear();
      face.texture_points.clear();
    }
  }
  for (Material& material : scene.materials) material.textures = {};
}

std::size_t compare(const std::string& name, const Scene& scene, const ComparisonSettings& settings,
                    const CameraChoice& cameras) {
  std::size_t different = 0;
  for (const Camera& camera : cameras_of(scene, cameras)) {
    try {
      const Comparison c = compare_blocks(scene, camera, settings);
      if (c.reference_error > kMostReferenceError) {
        fmt::print("| {} | {} | not compared: the reference is uncertain by {:.0f} % |\n", name, c.camera,
                   100 * c.reference_error);
        continue;
      }
      print(name, c);
      different += c.different();
    } catch (const std::invalid_argument& e) {
      fmt::print("| {} | not compared: {} |\n", name, e.what());
      break;
    }
  }
  return different;
}

struct Arguments {
  std::vector<std::filesystem::path> rooms;
  bool generated = false;
  bool one_room = false;
  bool flat = false;
  CameraChoice cameras;
  ComparisonSettings settings;
};

void add_arguments(bench::ProgramOptions& app, Arguments& to) {
  app.add_option("rooms", to.rooms, "Room files").existing_file();
  app.add_flag("--generated", to.generated, "Compare the 20 generated rooms with touching lamps");
  app.add_flag("--one-room", to.one_room, "All files together are one room (MGF)");
  app.add_option("--photometry", to.settings.photometry,
                 "IES file of the measured luminaires, read anew for the reference")
      .existing_file();
  app.add_flag("--flat", to.flat,
               "Leave out what the reference does not know: normals of files, images and colours of\n"
               "vertices on surfaces");
  app.add_option("--cameras", to.cameras.most, "Cameras of each room");
  app.add_option("--camera", to.cameras.name, "Camera by name, auto-1, auto-2, ... of rooms without any");
  app.add_option(
         "--still", to.settings.stills,
         "Check this EXR file of `reemit render` instead of rendering. Several are of the same view,\n"
         "each of a solution with another seed; of one alone the noise of its zones is not known")
      .existing_file();
  app.add_option("--width", to.settings.width, "Of pictures that are rendered [px]").show_default();
  app.add_option("--height", to.settings.height, "[px]").show_default();
  app.add_option("--seconds", to.settings.seconds, "For the reference of one picture [s]").show_default();
  app.add_option("--passes", to.settings.passes,
                 "Paths per pixel of the reference instead, a multiple of 8: the same on any machine");
  app.add_option("--reference-error", to.settings.reference_error,
                 "Median over blocks at which the reference stops sooner")
      .show_default();
  app.add_option("--packets", to.settings.packets, "Of the zone solutions, all together").show_default();
  app.add_option("--spp", to.settings.spp, "Of the checked stills, all together").show_default();
  app.add_option("--zone-area", to.settings.zone_area, "[m2]");
  app.add_option("--seed", to.settings.seed, "Of the first room; each has numbers of its own").show_default();
  app.add_option("--bias", to.settings.planted_bias, "Planted in the checked still, as a share");
  app.add_flag("--walk", to.settings.by_walks, "Solve the zones by walks instead of shooting");
  app.add_flag("--path", to.settings.by_path, "Check the path tracer instead of the gathered still");
}

/// Number of blocks that differ, of all rooms.
std::size_t compare_all(Arguments given) {
  fmt::print(
      "| room | camera | blocks | reference error of blocks, median / largest [%] | paths [1e6] "
      "| mean of the picture [%] | largest deviation [standard errors] "
      "| largest beyond 5 standard errors [%] | blocks that differ |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  std::size_t different = 0;
  const auto compare_next = [&](const std::string& name, Scene scene) {
    // Among them what paths lack, and so the reference.
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "{}: {}\n", name, warning);
    if (given.flat) drop_details(scene);
    different += compare(name, scene, given.settings, given.cameras);
    ++given.settings.seed;
  };
  if (given.generated)
    for (const std::uint32_t i : kTouchingLampsRooms)
      compare_next(fmt::format("touching lamps {}", i), touching_lamps_room(i));
  if (given.one_room) {
    compare_next(given.rooms.front().stem().string(), read_scene(given.rooms));
  } else {
    for (const auto& file : given.rooms) compare_next(file.stem().string(), read_scene(file));
  }
  return different;
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app(
      "Compares 16 x 16 blocks of stills with paths that only hit luminaires.\n"
      "Exit code 1 if a block differs by more than 5 standard errors and 3 %.");
  Arguments given;
  add_arguments(app, given);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  if (given.rooms.empty()) given.one_room = false;
  if (!given.settings.stills.empty() &&
      (given.generated || given.cameras.most != 1 || (given.rooms.size() != 1 && !given.one_room))) {
    fmt::print(stderr, "bench_hit_paths: stills are of one camera in one room\n");
    return 2;
  }
  try {
    return compare_all(std::move(given)) == 0 ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_hit_paths: {}\n", e.what());
    return 2;
  }
}
