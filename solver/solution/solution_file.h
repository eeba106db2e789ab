#pragma once
#include <cstdint>
#include <filesystem>

#include "solver/solution/packing.h"
#include "solver/solution/solution.h"

namespace reemit {

/// What the root attributes `format` and `format_version` of a solution file say.
inline constexpr const char* kSolutionFormat = "reemit solution";
inline constexpr std::uint32_t kSolutionFormatVersion = 12;

/// Writes a solution as HDF5, all of it that load_solution needs to go on solving, and zone values for other
/// programs; docs/solution_file.md specifies every dataset. The file appears whole or not at all: until then
/// the previous one stays. Throws ResourceError when it cannot be written, std::invalid_argument for a
/// solution whose parts do not fit together. Not for several threads at once: HDF5 is not; it packs with as
/// many as the settings say. `packing`: when what is left is stored without compression.
void save_solution(const Solution& solution, const std::filesystem::path& file,
                   const Packing& packing = Packing(nullptr));

/// Reads a solution file back: sums and audit are exactly those that were saved. Throws InputError with
/// advice when the file is missing, no solution file, of another format version, truncated or damaged.
Solution load_solution(const std::filesystem::path& file);

/// True if the file is HDF5, so that only load_solution can make sense of it; false also when it cannot be
/// read.
bool is_solution_file(const std::filesystem::path& file);

}  // namespace reemit
