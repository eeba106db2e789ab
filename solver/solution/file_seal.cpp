#include "solver/solution/file_seal.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#include <fmt/format.h>

namespace reemit {
namespace {

constexpr std::string_view kName = "reemit seal ";
constexpr std::size_t kSealBytes = kName.size() + 16 + 1;
constexpr std::uint64_t kEmptyHash = 0xcbf29ce484222325ULL;

std::uint64_t extend_hash(std::uint64_t hash, std::string_view bytes) {
  for (const char c : bytes) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

std::string seal_with(std::uint64_t hash) {
  return fmt::format("{}{:016x}\n", kName, hash);
}

}  // namespace

std::string seal_of(std::string_view bytes) {
  return seal_with(extend_hash(kEmptyHash, bytes));
}

bool ends_in_seal(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string seal(kSealBytes, '\0');
  return in.seekg(-static_cast<std::streamoff>(kSealBytes), std::ios::end) &&
         in.read(seal.data(), static_cast<std::streamsize>(seal.size())) && seal.starts_with(kName) &&
         seal.ends_with('\n');
}

Seal check_seal(const std::filesystem::path& file) {
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  std::ifstream in(file, std::ios::binary);
  if (code || size < kSealBytes || !in) return Seal::kMissing;

  std::uint64_t hash = kEmptyHash;
  std::vector<char> block(std::size_t{1} << 20);
  for (std::uintmax_t left = size - kSealBytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uintmax_t>(left, block.size()));
    if (!in.read(block.data(), static_cast<std::streamsize>(count))) return Seal::kMissing;
    hash = extend_hash(hash, {block.data(), count});
    left -= count;
  }
  std::string seal(kSealBytes, '\0');
  if (!in.read(seal.data(), static_cast<std::streamsize>(seal.size())) || !seal.starts_with(kName))
    return Seal::kMissing;
  return seal == seal_with(hash) ? Seal::kIntact : Seal::kBroken;
}

}  // namespace reemit
