#pragma once
#include <filesystem>
#include <optional>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Reads the room that a solution was made from, with the options of then. Looks for `override` if given,
/// else for the path stored in the solution, else for a file of the same name beside `solution_file`, so that
/// a folder with both can be moved. Throws InputError with advice when there is none, or when its content is
/// no longer what was solved.
Scene read_room_of(const Solution& solution, const std::filesystem::path& solution_file,
                   const std::optional<std::filesystem::path>& override = std::nullopt);

}  // namespace reemit
