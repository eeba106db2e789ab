#include "viewer_export/cli/loading.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "mesh/zones/total_powers.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/solution_file.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/step_note.h"

namespace reemit::cli {
namespace fs = std::filesystem;
namespace {

/// Steps that are shorter than this are not worth a word [s].
constexpr double kQuietSeconds = 1;

ProgressStyle style_of(const OutputStyle& style) {
  return progress_style(style.quiet, style.verbose);
}

/// "reading hall.obj (412 MB)".
std::string reading(const std::vector<fs::path>& files) {
  constexpr double kMegabyte = 1e6;
  double bytes = 0;
  for (const fs::path& file : files) {
    std::error_code unknown;
    const std::uintmax_t size = fs::file_size(file, unknown);
    if (!unknown) bytes += static_cast<double>(size);
  }
  std::string text = "reading";
  if (!files.empty()) text += " " + files.front().filename().string();
  if (files.size() > 1) text += fmt::format(" and {} more", files.size() - 1);
  if (bytes >= kMegabyte) text += fmt::format(" ({:.0f} MB)", bytes / kMegabyte);
  return text;
}

/// The option given that is for glTF alone; null if none is.
const char* gltf_option(const ReadOptions& options) {
  if (options.gltf_emissive_units != ReadOptions{}.gltf_emissive_units) return "--emissive-units";
  return options.gltf_light_efficacy ? "--gltf-light-efficacy" : nullptr;
}

void check_reads_gltf(const ReadOptions& options, const Scene& scene) {
  const char* option = gltf_option(options);
  if (option == nullptr) return;
  for (const std::string& file : scene.files) {
    const std::string extension = lower_case_extension(file);
    if (extension == ".gltf" || extension == ".glb") return;
  }
  throw InputError(option, "is for glTF, and no file of this room is glTF", "Leave it out.");
}

}  // namespace

Scene load_room(const std::vector<fs::path>& files, const ReadOptions& options, const OutputStyle& style) {
  const StepNote note(reading(files), style);
  const WaitingLine line(reading(files), style_of(style));
  Scene scene = read_scene(files, options);
  check_reads_gltf(options, scene);
  return scene;
}

MeshResult mesh_room(Scene& scene, const MeshSettings& settings, const OutputStyle& style) {
  const StepNote note("meshing", style);
  Progress progress("meshing", style_of(style), kQuietSeconds);
  MeshResult meshed = build_zones(scene, settings, WorkWatch([&](double done) { progress.update(done); }));
  spread_total_powers(meshed.report, meshed.mesh, scene);
  return meshed;
}

bool is_meant_as_solution(const fs::path& file) {
  return is_solution_file(file) || file.extension() == ".h5" || file.extension() == ".hdf5";
}

void check_no_read_options(const ReadOptions& options, const fs::path& solution) {
  const char* given = gltf_option(options);
  if (options.bands.given()) given = "--bands";
  if (options.force_two_sided) given = "--two-sided";
  if (!options.sky.empty()) given = "--sky";
  if (!options.sun.empty()) given = "--sun";
  if (given == nullptr) return;
  throw InputError(
      given, "is for rooms, and " + solution.string() + " is a solution, whose room is as it was solved",
      "Leave it out, or solve the room again with it.");
}

Solution load_solution(const fs::path& file, const OutputStyle& style) {
  const StepNote note(reading({file}), style);
  const WaitingLine line(reading({file}), style_of(style));
  return reemit::load_solution(file);
}

Scene load_room_of(const Solution& solution, const fs::path& solution_file,
                   const std::vector<fs::path>& override, const OutputStyle& style) {
  const std::vector<std::string> stored = room_files(solution);
  const std::string step =
      reading(override.empty() ? std::vector<fs::path>(stored.begin(), stored.end()) : override);
  const StepNote note(step, style);
  const WaitingLine line(step, style_of(style));
  return read_room_of(solution, solution_file, override);
}

Room build_room(const Scene& scene, const ZoneMesh& mesh, const OutputStyle& style) {
  const StepNote note("building the tree for rays", style);
  const WaitingLine line("building the tree for rays", style_of(style));
  return Room(scene, mesh);
}

}  // namespace reemit::cli
