// Numbers that others published for the same generators: what is uniform and independent by chance may still
// be another generator than the one whose tests were passed in the literature.
#include <array>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"

namespace reemit {
namespace {

struct PhiloxAnswer {
  std::array<std::uint32_t, 4> counter;
  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> bits;
};

/// philox4x32 with 7 rounds in kat_vectors of Random123 [SMDS11]: zeros, ones, and digits of pi.
constexpr std::array<PhiloxAnswer, 3> kPhilox7{{
    {{0, 0, 0, 0}, {0, 0}, {0x5f6fb709, 0x0d893f64, 0x4f121f81, 0x4f730a48}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
     {0xffffffff, 0xffffffff},
     {0x5207ddc2, 0x45165e59, 0x4d8ee751, 0x8c52f662}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0x4dfccaba, 0x190a87f0, 0xc47362ba, 0xb6b5242a}},
}};

/// The generator whose key, which seed and purpose make together, is `key`.
CounterRng rng_of_key(const std::array<std::uint32_t, 2>& key, RngPurpose purpose) {
  const auto p = static_cast<std::uint32_t>(purpose);
  return {std::uint64_t{key[1] - p} << 32 | (key[0] ^ (p * 0x9E3779B9U)), purpose};
}

TEST(PhiloxKnownAnswers, BlocksAreThoseOfRandom123) {
  for (const PhiloxAnswer& answer : kPhilox7)
    for (const RngPurpose purpose : {RngPurpose::kEmission, RngPurpose::kArrival}) {
      const auto& c = answer.counter;
      const CounterRng rng = rng_of_key(answer.key, purpose);
      EXPECT_EQ(rng.bits4(std::uint64_t{c[1]} << 32 | c[0], c[2], c[3]), answer.bits) << std::hex << c[0];
    }
}

TEST(PhiloxKnownAnswers, SixteenAtOnceAreThoseOfRandom123) {
  // Lanes have indices of 32 bits, so of the three only the counter of zeros can be asked for.
  const std::array<std::uint32_t, 16> index{};
  BitLanes lanes;
  rng_of_key(kPhilox7[0].key, RngPurpose::kEmission).bits4x16(index.data(), 0, 0, lanes);
  for (std::size_t word = 0; word < 4; ++word)
    for (const std::uint32_t bits : lanes.word[word]) EXPECT_EQ(bits, kPhilox7[0].bits[word]) << word;
}

struct SobolAnswer {
  std::array<std::uint32_t, 10> m;  ///< First direction numbers m_k: odd and below 2^k.
  std::uint32_t last;               ///< The 32nd, which all before it have a part in.
  std::array<double, 8> points;     ///< The first, in the order of Gray codes.
};

/// Of dimensions 2 to 8 of new-joe-kuo-6.21201 [JK08]: direction numbers as in the tables that L.
/// Gruenschloss made of that file, points as the authors' program sobol.cc prints them.
constexpr std::array<SobolAnswer, 7> kSobol{{
    {{1, 3, 5, 15, 17, 51, 85, 255, 257, 771}, 0xffffffff, {0, .5, .25, .75, .375, .875, .125, .625}},
    {{1, 3, 3, 9, 29, 23, 71, 197, 209, 627}, 0xc5005555, {0, .5, .25, .75, .625, .125, .875, .375}},
    {{1, 3, 1, 5, 31, 29, 81, 147, 433, 149}, 0x50050093, {0, .5, .25, .75, .875, .375, .625, .125}},
    {{1, 1, 1, 11, 31, 55, 61, 157, 181, 191}, 0xb00ddb9d, {0, .5, .75, .25, .375, .875, .625, .125}},
    {{1, 1, 3, 3, 25, 9, 43, 251, 449, 449}, 0x40bbbbbb, {0, .5, .75, .25, .125, .625, .875, .375}},
    {{1, 3, 5, 13, 11, 37, 31, 227, 381, 143}, 0xc0104477, {0, .5, .25, .75, .375, .875, .125, .625}},
    {{1, 1, 5, 5, 17, 9, 9, 45, 237, 633}, 0x87639641, {0, .5, .75, .25, .875, .375, .125, .625}},
}};

TEST(SobolKnownAnswers, DirectionNumbersAreThoseOfJoeAndKuo) {
  ASSERT_EQ(kSobol.size() + 1, static_cast<std::size_t>(kSobolDimensions));
  for (int dimension = 1; dimension < kSobolDimensions; ++dimension) {
    const SobolAnswer& answer = kSobol[static_cast<std::size_t>(dimension) - 1];
    for (std::size_t k = 0; k < answer.m.size(); ++k)
      EXPECT_EQ(sobol_bits(1U << k, dimension), answer.m[k] << (31 - k))
          << "dimension " << dimension + 1 << ", direction number " << k + 1;
    EXPECT_EQ(sobol_bits(1U << 31, dimension), answer.last) << "dimension " << dimension + 1;
  }
}

TEST(SobolKnownAnswers, FirstPointsAreThoseOfJoeAndKuo) {
  constexpr std::array<double, 8> kFirstDimension{0, .5, .75, .25, .375, .875, .625, .125};
  for (int dimension = 0; dimension < kSobolDimensions; ++dimension) {
    const std::array<double, 8>& points =
        dimension == 0 ? kFirstDimension : kSobol[static_cast<std::size_t>(dimension) - 1].points;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(sobol_bits(i ^ (i >> 1), dimension) * 0x1p-32, points[i])
          << "dimension " << dimension + 1 << ", point " << i;
  }
}

TEST(SobolKnownAnswers, FirstDimensionReversesBits) {
  for (const std::uint32_t bit : {0U, 1U, 9U, 31U}) EXPECT_EQ(sobol_bits(1U << bit, 0), 1U << (31 - bit));
}

}  // namespace
}  // namespace reemit
