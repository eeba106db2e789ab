#pragma once
#include <filesystem>
#include <vector>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Throws InputError unless a room and its zones are what a solution was made from. Its zones are looked at
/// alone where it does not know what it was made from (Solution::room_hash is empty).
void check_is_room_of(const Solution& solution, const Scene& scene, const ZoneMesh& mesh);

/// Reads the room that a solution was made from, with the options of then. Takes the files of `override` if
/// there are any; else looks for each file of the room at the path stored in the solution, then for one of
/// the same name beside `solution_file`, so that a folder with all can be moved. Throws InputError with
/// advice when there is none, or when its content is no longer what was solved.
Scene read_room_of(const Solution& solution, const std::filesystem::path& solution_file,
                   const std::vector<std::filesystem::path>& override = {});

}  // namespace reemit
