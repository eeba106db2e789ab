#include "solver/solution/file_seal.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "scenes/model/fnv1a.h"

namespace reemit {
namespace {

constexpr std::string_view kName = "reemit seal ";
constexpr std::size_t kSealBytes = kName.size() + 16 + 1;

void add(std::string_view bytes, Fnv1a& hash) {
  for (const char c : bytes) hash.add(static_cast<unsigned char>(c));
}

std::string seal_with(const Fnv1a& hash) {
  return fmt::format("{}{:016x}\n", kName, hash.state());
}

}  // namespace

std::string seal_of(std::string_view bytes) {
  Fnv1a hash;
  add(bytes, hash);
  return seal_with(hash);
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

  Fnv1a hash;
  std::vector<char> block(std::size_t{1} << 20);
  for (std::uintmax_t left = size - kSealBytes; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uintmax_t>(left, block.size()));
    if (!in.read(block.data(), static_cast<std::streamsize>(count))) return Seal::kMissing;
    add({block.data(), count}, hash);
    left -= count;
  }
  std::string seal(kSealBytes, '\0');
  if (!in.read(seal.data(), static_cast<std::streamsize>(seal.size())) || !seal.starts_with(kName))
    return Seal::kMissing;
  return seal == seal_with(hash) ? Seal::kIntact : Seal::kBroken;
}

}  // namespace reemit
