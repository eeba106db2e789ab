#include "solver/sampling/sobol.h"

#include "scenes/model/instruction_sets.h"
#include "solver/sampling/split_mix.h"

namespace reemit {
namespace {

using DirectionNumbers = std::array<std::uint32_t, 32>;

/// Primitive polynomial (degree s, coefficients a) and first direction numbers m of one dimension,
/// new-joe-kuo-6 [JK08].
struct Polynomial {
  int degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 5> m;
};

constexpr std::array<Polynomial, kSobolDimensions - 1> kPolynomials{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
}};

constexpr std::array<DirectionNumbers, kSobolDimensions> make_directions() {
  std::array<DirectionNumbers, kSobolDimensions> all{};
  for (std::size_t bit = 0; bit < 32; ++bit) all[0][bit] = 1U << (31 - bit);
  for (std::size_t d = 1; d < all.size(); ++d) {
    const Polynomial& p = kPolynomials[d - 1];
    const auto s = static_cast<std::size_t>(p.degree);
    DirectionNumbers& v = all[d];
    for (std::size_t i = 0; i < s; ++i) v[i] = p.m[i] << (31 - i);
    for (std::size_t i = s; i < 32; ++i) {
      v[i] = v[i - s] ^ (v[i - s] >> s);
      for (std::size_t k = 1; k < s; ++k)
        if ((p.coefficients >> (s - 1 - k)) & 1U) v[i] ^= v[i - k];
    }
  }
  return all;
}

constexpr auto kDirections = make_directions();

/// What each value of each four bits of an index contributes to a point, which is linear over XOR: bits
/// reversed, as owen_scramble needs them first.
using NibblePoints = std::array<std::array<std::uint32_t, 16>, 8>;

constexpr std::array<NibblePoints, kSobolDimensions> make_nibble_points() {
  std::array<NibblePoints, kSobolDimensions> all{};
  for (std::size_t d = 0; d < all.size(); ++d)
    for (std::size_t nibble = 0; nibble < 8; ++nibble)
      for (std::uint32_t i = 0; i < 16; ++i)
        for (std::size_t bit = 0; bit < 4; ++bit)
          if ((i >> bit) & 1U) all[d][nibble][i] ^= reversed_bits(kDirections[d][4 * nibble + bit]);
  return all;
}

alignas(64) constexpr auto kNibblePoints = make_nibble_points();

}  // namespace

std::uint32_t reversed_sobol_bits(std::uint32_t index, int dimension) {
  const NibblePoints& points = kNibblePoints[static_cast<std::size_t>(dimension)];
  std::uint32_t x = 0;
  for (std::size_t nibble = 0; index != 0; ++nibble, index >>= 4) x ^= points[nibble][index & 15U];
  return x;
}

SobolSequence::SobolSequence(std::uint64_t seed) {
  SplitMix numbers(seed);
  for (std::uint32_t& s : seeds_) s = static_cast<std::uint32_t>(numbers.next() >> 32);
}

REEMIT_FOR_INSTRUCTION_SETS
void SobolSequence::sample16(std::uint32_t first_index, int dimension, float* out) const {
  const auto d = static_cast<std::size_t>(dimension);
  const NibblePoints& points = kNibblePoints[d];
  const std::uint32_t high = reversed_sobol_bits(first_index, dimension);
  const std::uint32_t seed = seeds_[d];
  for (std::size_t i = 0; i < 16; ++i)
    out[i] = unit(reversed_bits(scrambled_reversed(high ^ points[0][i], seed)));
}

}  // namespace reemit
