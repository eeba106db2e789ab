#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/room/room.h"
#include "viewer_export/still/default_cameras.h"

namespace reemit::bench {
namespace {

/// The same room without colour: reflectances and radiances are means over the bands. For rooms of diffuse
/// surfaces lit by surfaces.
Scene grey(Scene scene) {
  const auto mean_of = [](Spectrum& s) { s = Spectrum::Constant(1, s.mean()); };
  for (Material& m : scene.materials) {
    mean_of(m.reflectance);
    mean_of(m.emitted_radiance);
  }
  scene.bands = BandSet::grey();
  finish_scene(scene);
  return scene;
}

Camera first_camera(const Scene& scene) {
  if (!scene.cameras.empty()) return scene.cameras.front();
  const MeshResult mesh = build_mesh(scene);
  const Room walls(scene, mesh.mesh);
  return default_cameras(walls).front();
}

/// A file below a folder, wherever it is.
std::optional<std::filesystem::path> find_below(const std::filesystem::path& folder,
                                                const std::string& file) {
  if (folder.empty() || !std::filesystem::is_directory(folder)) return std::nullopt;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().string().ends_with(file)) found.push_back(entry.path());
  if (found.empty()) return std::nullopt;
  return *std::min_element(found.begin(), found.end());
}

std::vector<StudiedRoom> cornell_boxes(const std::filesystem::path& library) {
  StudiedRoom box;
  box.name = "cornell_box";
  box.scene = read_scene(library / "cornell_box.json");
  box.camera = first_camera(box.scene);
  box.picture_size = 256;
  box.tile_stride = 8;
  box.reference_samples = 4096;
  box.path_samples = {16, 64, 256};
  box.vertex_stride = 13;
  box.vertex_zone_area = 3.1e-5;
  StudiedRoom grey_box = box;
  grey_box.name = "cornell_box grey";
  grey_box.scene = grey(box.scene);
  grey_box.stills_only = true;
  return {std::move(box), std::move(grey_box)};
}

}  // namespace

std::vector<StudiedRoom> find_rooms(const Options& options, Table& table) {
  const std::filesystem::path library = std::filesystem::path(REEMIT_SOURCE_DIR) / "scenes/library";
  std::vector<StudiedRoom> rooms = cornell_boxes(library);
  const auto add = [&](const std::string& name, const std::filesystem::path& file,
                       double vertex_zone_area) -> StudiedRoom& {
    StudiedRoom room;
    room.name = name;
    room.scene = read_scene(file);
    room.camera = first_camera(room.scene);
    room.path_samples = {16, 64, 256};
    room.vertex_zone_area = vertex_zone_area;
    return rooms.emplace_back(std::move(room));
  };
  {
    StudiedRoom& office = add("office", library / "office.json", 0.02);
    office.vertex_stride = 19;
    office.picture_size = 256;
    office.tile_stride = 8;
    office.reference_samples = 2048;
    office.path_samples = {8, 32, 128};
  }
  for (const auto& [name, file] :
       {std::pair("mirrors", "metals.json"), std::pair("glass", "caustic_ball.json"),
        std::pair("gloss", "gloss.json")}) {
    StudiedRoom& room =
        add(name, std::filesystem::path(REEMIT_SOURCE_DIR) / "bench/hit_paths/rooms" / file, 0);
    room.stills_only = true;
    room.reference_samples = 8192;
  }
  const auto add_found = [&](const std::string& name, const std::string& file,
                             double vertex_zone_area) -> StudiedRoom* {
    if (const auto path = find_below(options.rooms, file)) return &add(name, *path, vertex_zone_area);
    table.notes.push_back(
        fmt::format("{}: left out, {} is not below the folder given by --rooms", name, file));
    return nullptr;
  };
  for (const char* name : {"scene3", "scene6"})
    add_found(fmt::format("erw5_{}", name), fmt::format("erw5/{}.mgf", name), 0.012);
  for (const auto& [name, file] : {std::pair("conference_1994", "conference_1994/conf.mgf"),
                                   std::pair("modern_hall", "modern_hall/modern_hall.obj")})
    if (StudiedRoom* room = add_found(name, file, 0)) {
      room->stills_only = true;
      room->picture_size = 256;
      room->tile_stride = 8;
      room->reference_samples = 2048;
      room->path_samples = {8, 32, 128};
      room->longer_stills = name == std::string_view("modern_hall");
      if (room->longer_stills) room->reference_samples = 8192;
    }
  return rooms;
}

}  // namespace reemit::bench
