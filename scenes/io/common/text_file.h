#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace reemit {

/// Largest file a reader loads [bytes].
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

/// Before a file is read: throws InputError unless the path names a regular, non-empty file of at most
/// `largest` bytes. Adds it to FilesRead.
void check_readable_file(const std::filesystem::path& file, std::uintmax_t largest = kLargestFile);

/// The bytes of a file after check_readable_file; throws InputError when it cannot be opened or read,
/// is UTF-16 or a pointer of Git LFS.
std::string load_file(const std::filesystem::path& file, std::uintmax_t largest = kLargestFile);

}  // namespace reemit
