#pragma once
#include <cstdint>

namespace reemit {

/// FNV-1a, 64 bit [FNV], of bytes, or of words of 32 bits, which is four times as fast and another hash. What
/// solutions and their seals hold depends on it.
class Fnv1a {
 public:
  void add(std::uint32_t byte_or_word) {
    state_ ^= byte_or_word;
    state_ *= 0x100000001b3ULL;
  }
  std::uint64_t state() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

}  // namespace reemit
