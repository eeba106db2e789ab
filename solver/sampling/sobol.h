#pragma once
#include <array>
#include <cstdint>

namespace reemit {

/// Sobol' points with Owen scrambling by hashing. Direction numbers of [JK08]; hash-based nested uniform
/// scrambling of [BUR20, listings 2 and 3]. Any aligned block of 2^m consecutive indices is a (t,m,s)-net.
inline constexpr int kSobolDimensions = 8;

/// Bits of an unscrambled point from last to first. Pre: 0 <= dimension < kSobolDimensions.
std::uint32_t reversed_sobol_bits(std::uint32_t index, int dimension);

/// Bit k becomes bit 31 - k.
constexpr std::uint32_t reversed_bits(std::uint32_t v) {
  v = ((v >> 1) & 0x55555555U) | ((v & 0x55555555U) << 1);
  v = ((v >> 2) & 0x33333333U) | ((v & 0x33333333U) << 2);
  v = ((v >> 4) & 0x0F0F0F0FU) | ((v & 0x0F0F0F0FU) << 4);
  v = ((v >> 8) & 0x00FF00FFU) | ((v & 0x00FF00FFU) << 8);
  return (v >> 16) | (v << 16);
}

/// Unscrambled point, one 32-bit fraction. Pre: 0 <= dimension < kSobolDimensions.
inline std::uint32_t sobol_bits(std::uint32_t index, int dimension) {
  return reversed_bits(reversed_sobol_bits(index, dimension));
}

/// owen_scramble of a fraction whose bits are reversed, before and after.
inline std::uint32_t scrambled_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

/// Nested uniform scrambling in base 2 of a 32-bit fraction; a different permutation tree for each seed.
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reversed_bits(scrambled_reversed(reversed_bits(x), seed));
}

/// One scrambled sequence: every (seed) is an independent randomisation, so each point alone is uniform.
class SobolSequence {
 public:
  /// `seed`: 64 random bits, e.g. of CounterRng.
  explicit SobolSequence(std::uint64_t seed);

  float sample(std::uint32_t index, int dimension) const {
    return unit(reversed_bits(scrambled_reversed(reversed_sobol_bits(index, dimension),
                                                 seeds_[static_cast<std::size_t>(dimension)])));
  }
  /// The samples of points first_index .. first_index+15, sooner; first_index is a multiple of 16.
  void sample16(std::uint32_t first_index, int dimension, float* out) const;

 private:
  static float unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }
  std::array<std::uint32_t, kSobolDimensions> seeds_{};
};

}  // namespace reemit
