#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace reemit {

// HDF5 is not safe against damaged files: it may loop or crash, at the latest when the program ends. So a
// solution file ends in a line with a checksum, behind what HDF5 reads, and HDF5 sees only files whose
// checksum is right.

/// The last line of a file with these bytes: "reemit seal " and the FNV-1a 64-bit hash [FNV] of them as 16
/// hex digits.
std::string seal_of(std::string_view bytes);

/// What the last line of a file says: the right checksum, nothing, or a wrong one.
enum class Seal { kIntact, kMissing, kBroken };

/// Reads a whole file and compares. A file that cannot be read has no seal.
Seal check_seal(const std::filesystem::path& file);

/// Whether a file ends like one of ours, intact or not: reads its last line only.
bool ends_in_seal(const std::filesystem::path& file);

}  // namespace reemit
