#pragma once
#include <filesystem>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/cli/command_options.h"

namespace reemit::cli {

// What comes before a command can begin, with a line of progress where it takes longer than a second. Nothing
// guards it: a signal ends the program at once.

/// As read_scene; throws InputError also for options that are for glTF if the room has none of it.
Scene load_room(const std::vector<std::filesystem::path>& files, const ReadOptions& options,
                const OutputStyle& style);
/// As build_zones, and settles the luminaires by it (spread_total_powers).
MeshResult mesh_room(Scene& scene, const MeshSettings& settings, const OutputStyle& style);
/// True for a solution file, also one that is cut short at its start, empty or not there.
bool is_meant_as_solution(const std::filesystem::path& file);
/// Throws InputError, which names the option, if any of those that say how a room is to be read was given for
/// a solution, whose room is read as it was when it was solved.
void check_no_read_options(const ReadOptions& options, const std::filesystem::path& solution);
/// As reemit::load_solution.
Solution load_solution(const std::filesystem::path& file, const OutputStyle& style);
/// As read_room_of.
Scene load_room_of(const Solution& solution, const std::filesystem::path& solution_file,
                   const std::vector<std::filesystem::path>& override, const OutputStyle& style);
/// Scene and mesh must outlive the room.
Room build_room(const Scene& scene, const ZoneMesh& mesh, const OutputStyle& style);

}  // namespace reemit::cli
