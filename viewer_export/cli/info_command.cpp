#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "solver/losses/luminaire_warnings.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/inspection_report.h"
#include "viewer_export/cli/light_report.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/luminaire_list.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/room_report.h"
#include "viewer_export/cli/solution_report.h"

namespace reemit::cli {
namespace {

struct InfoOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path report;  ///< Empty: none.
  ReadOptions read;
  OutputStyle style;
};

/// What is left of the room of a solution.
struct RoomOfSolution {
  std::string status = "unchanged";  ///< Or why it cannot be read or is not the one that was solved.
  std::vector<LuminaireRow> luminaires;
  std::optional<LightOutside> outside;  ///< Under a sky.
};

std::optional<LightOutside> light_outside(const Scene& scene) {
  if (!scene.sky) return std::nullopt;
  return LightOutside{lumens(horizontal_sky_irradiance(*scene.sky, scene.bands), scene.bands),
                      lumens(horizontal_sun_irradiance(*scene.sky, scene.bands), scene.bands)};
}

RoomOfSolution find_room(const Solution& solution, const std::filesystem::path& file,
                         const OutputStyle& style) {
  RoomOfSolution room;
  try {
    const Scene scene = load_room_of(solution, file, {}, style);
    room.luminaires = list_luminaires(scene, solution);
    room.outside = light_outside(scene);
  } catch (const InputError& problem) {
    const std::string message = problem.what();
    room.status = message.substr(0, message.find('\n'));
    room.luminaires = list_luminous_surfaces(solution);
  }
  return room;
}

ExitCode show_solution(const InfoOptions& options) {
  const std::filesystem::path& file = options.files.front();
  check_no_read_options(options.read, file);
  const Solution solution = load_solution(file, options.style);
  const RoomOfSolution room = find_room(solution, file, options.style);
  if (options.style.json) {
    nlohmann::ordered_json json = solution_json(solution, file, room.status);
    add_light(json, solution, room.luminaires, room.outside);
    print_json(json);
  } else {
    print_result(solution_text(solution, file, room.status) + '\n' +
                 light_text(solution, room.luminaires, room.outside));
  }
  std::fflush(stdout);
  if (options.style.quiet) return ExitCode::kDone;
  print_warnings(solution.mesh_report.warnings);
  print_warnings(solution.light_warnings);
  return ExitCode::kDone;
}

ExitCode show_room(const InfoOptions& options) {
  const bool reports = !options.report.empty();
  if (reports) check_report(options.report, options.files);
  Scene scene = load_room(options.files, options.read, options.style);
  const MeshResult meshed = mesh_room(scene, {}, options.style);
  if (reports) write_report(options.report, scene, meshed, options.style);
  const std::vector<std::string> light_warnings = luminaire_warnings(scene, meshed.mesh);
  if (options.style.json) {
    nlohmann::ordered_json json = room_json(scene, meshed, light_warnings);
    add_inspection(json, scene, meshed, options.report);
    print_json(json);
  } else {
    print_result(room_text(scene, meshed));
    if (reports) print_result('\n' + inspection_text(scene, meshed, options.report));
  }
  std::fflush(stdout);
  if (options.style.quiet) return ExitCode::kDone;
  print_warnings(scene.warnings);
  print_warnings(meshed.report.warnings);
  print_warnings(light_warnings);
  return ExitCode::kDone;
}

ExitCode show(const InfoOptions& options) {
  const auto solution = std::find_if(options.files.begin(), options.files.end(), is_meant_as_solution);
  if (solution == options.files.end()) {
    try {
      return show_room(options);
    } catch (const InputError& problem) {
      if (options.style.json) print_json(refused_room_json(options.files, problem.what()));
      throw;
    }
  }
  if (options.files.size() > 1)
    throw InputError(solution->string(), "it is a solution, and it is not the only file",
                     "Give one solution, or the files of one room.");
  if (!options.report.empty())
    throw InputError("--report", "a solution file does not keep what meshing did to the faces",
                     "Give the room: reemit info ROOM --report " + options.report.string());
  return show_solution(options);
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App& info = *program.add_subcommand("info", "Say what a room or a solution holds");
  info.footer(
      "Warnings about the geometry go to stderr, and into the document with --json, which also counts by\n"
      "kind what of the files was refused and what is not modelled.\n"
      "Examples:\n"
      "  reemit info room.json    units, size, materials, luminaires, cameras\n"
      "  reemit info room.json --report room.glb   what meshing did to which face, to look at\n"
      "  reemit info room.h5      lux, exitance and flux of every surface and material, with errors");
  info.add_option("file", options->files,
                  "Room (.json .obj .gltf .glb .mgf; several .mgf files are read in order as one room)\n"
                  "or solution file")
      ->required()
      ->type_name("ROOM|SOLUTION");
  info.add_option(
          "--report", options->report,
          "Also write a picture of the mesh of a room to this .glb file: faces by what meshing did to\n"
          "them, sides that no light reaches, zones by size; and print the first faces of each kind")
      ->type_name("FILE");
  add_read_options(info, options->read);
  add_sky_options(info, options->read);
  add_json_option(info, options->style);
  add_progress_options(info, options->style);
  info.callback([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace reemit::cli
