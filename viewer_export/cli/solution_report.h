#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "solver/solution/solution.h"

namespace reemit::cli {

/// How form factors came about, for people, without a last newline.
std::string form_factor_text(const FormFactorReport& report);
/// The same for `solve --json` and `export --json`.
nlohmann::ordered_json form_factor_json(const FormFactorReport& report);

/// What a user should know about how a run ended: power left unshot beyond SolverSettings::stop_share, an
/// error that is not known because there was one batch only.
std::vector<std::string> solve_warnings(const Solution& solution);

/// The same for those who use the solution later, and that it is but a checkpoint.
std::vector<std::string> state_warnings(const Solution& solution, const std::filesystem::path& file);

/// Where the rows of form factors do not add up.
std::vector<std::string> form_factor_warnings(const FormFactorReport& report);

/// The line `solve` ends with: why it stopped, packets, rays, seconds, error; for the matrix method more
/// about the form factors.
std::string solve_line(const Solution& solution);
/// The same as the document of `solve --json` (docs/command_line.md), with all warnings and the notes of the
/// room.
nlohmann::ordered_json solve_json(const Scene& scene, const Solution& solution,
                                  const std::filesystem::path& file);

/// What `info` says about a solution. `room_status` in words: whether the room is still the one solved.
std::string solution_text(const Solution& solution, const std::filesystem::path& file,
                          const std::string& room_status);
/// The same as the document of `info --json` (docs/command_line.md).
nlohmann::ordered_json solution_json(const Solution& solution, const std::filesystem::path& file,
                                     const std::string& room_status);

}  // namespace reemit::cli
