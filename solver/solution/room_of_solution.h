#pragma once
#include <filesystem>
#include <vector>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Throws InputError unless a room has the bands, surfaces and zones that a solution holds values of.
void check_has_zones_of(const Solution& solution, const Scene& scene, const ZoneMesh& mesh);

/// The same unless a room is what a solution was made from, in all that its hash counts; where the solution
/// does not know that (Solution::room_hash is empty) it is check_has_zones_of.
void check_is_room_of(const Solution& solution, const Scene& scene, const ZoneMesh& mesh);

/// Reads the room that a solution was made from, with the options of then. Takes the files of `override` if
/// there are any; else looks for each file of the room at the path stored in the solution, then for one of
/// the same name beside `solution_file`, so that a folder with all can be moved. Throws InputError with
/// advice when there is none, or when its content is no longer what was solved.
Scene read_room_of(const Solution& solution, const std::filesystem::path& solution_file,
                   const std::vector<std::filesystem::path>& override = {});

}  // namespace reemit
