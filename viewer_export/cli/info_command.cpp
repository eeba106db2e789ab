#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/error.h"
#include "solver/losses/luminaire_warnings.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/light_report.h"
#include "viewer_export/cli/luminaire_list.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/room_report.h"
#include "viewer_export/cli/solution_report.h"

namespace reemit::cli {
namespace {

struct InfoOptions {
  std::filesystem::path file;
  ReadOptions read;
  OutputStyle style;
};

/// A solution file cut short at its start or empty is still meant as one.
bool is_solution(const std::filesystem::path& path) {
  return is_solution_file(path) || path.extension() == ".h5" || path.extension() == ".hdf5";
}

/// What is left of the room of a solution.
struct RoomOfSolution {
  std::string status = "unchanged";  ///< Or why it cannot be read or is not the one that was solved.
  std::vector<LuminaireRow> luminaires;
};

RoomOfSolution find_room(const Solution& solution, const std::filesystem::path& file) {
  RoomOfSolution room;
  try {
    room.luminaires = list_luminaires(read_room_of(solution, file), solution.mesh_report);
  } catch (const InputError& problem) {
    const std::string message = problem.what();
    room.status = message.substr(0, message.find('\n'));
    room.luminaires = list_luminous_surfaces(solution);
  }
  return room;
}

ExitCode show_solution(const InfoOptions& options) {
  const Solution solution = load_solution(options.file);
  const RoomOfSolution room = find_room(solution, options.file);
  if (options.style.json) {
    nlohmann::ordered_json json = solution_json(solution, options.file, room.status);
    add_light(json, solution, room.luminaires);
    fmt::print("{}\n", json.dump(2));
    return ExitCode::kDone;
  }
  fmt::print("{}\n{}", solution_text(solution, options.file, room.status),
             light_text(solution, room.luminaires));
  std::fflush(stdout);
  print_warnings(solution.mesh_report.warnings);
  print_warnings(solution.light_warnings);
  return ExitCode::kDone;
}

ExitCode show_room(const InfoOptions& options) {
  const Scene scene = read_scene(options.file, options.read);
  const MeshResult meshed = build_mesh(scene);
  const std::vector<std::string> light_warnings = luminaire_warnings(scene, meshed.mesh);
  if (options.style.json) {
    fmt::print("{}\n", room_json(scene, meshed, light_warnings).dump(2));
  } else {
    fmt::print("{}", room_text(scene, meshed));
    std::fflush(stdout);
    print_warnings(scene.warnings);
    print_warnings(meshed.report.warnings);
    print_warnings(light_warnings);
  }
  return ExitCode::kDone;
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App& info = *program.add_subcommand("info", "Say what a room or a solution holds");
  info.footer(
      "Warnings about the geometry go to stderr, and into the document with --json.\n"
      "Examples:\n"
      "  reemit info room.json    units, size, materials, luminaires, cameras\n"
      "  reemit info room.h5      lux, exitance and flux of every surface and material, with errors");
  info.add_option("file", options->file, "Room (.json .obj .gltf .glb .mgf) or solution file")
      ->required()
      ->type_name("ROOM|SOLUTION");
  add_gltf_unit_options(info, options->read);
  add_json_option(info, options->style);
  info.callback([options, &action] {
    action = [options] { return is_solution(options->file) ? show_solution(*options) : show_room(*options); };
  });
}

}  // namespace reemit::cli
