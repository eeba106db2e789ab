#pragma once
#include <cstdint>

namespace reemit {

/// Bits that depend on every bit of x, one to one [MUR3].
inline std::uint32_t mixed_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bU;
  x ^= x >> 13;
  x *= 0xc2b2ae35U;
  return x ^ (x >> 16);
}

}  // namespace reemit
