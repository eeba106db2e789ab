#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

TEST(CounterRng, PairsOfDimensionsAreUniform) {
  const CounterRng rng(42, RngPurpose::kEmission);
  for (std::size_t a = 0; a < 4; ++a) {
    std::vector<double> counts(32 * 32);
    const std::vector<double> expected(32 * 32, 200'000.0 / (32 * 32));
    for (std::uint64_t i = 0; i < 200'000; ++i) {
      const auto u = rng.uniform4(i, 7, 3);
      const auto x = static_cast<std::size_t>(u[a] * 32);
      const auto y = static_cast<std::size_t>(u[(a + 1) % 4] * 32);
      counts[32 * x + y] += 1;
    }
    EXPECT_GT(test::chi_square_of_counts(counts, expected), test::kFalseAlarm) << "dimension " << a;
  }
}

TEST(CounterRng, NeighbouringCountersAreIndependent) {
  // Pairs (index, index+1), (batch, batch+1), (step, step+1) and of two purposes fill the square evenly.
  const CounterRng rng(1, RngPurpose::kEmission);
  const CounterRng other(1, RngPurpose::kReflection);
  std::vector<std::vector<double>> counts(4, std::vector<double>(256));
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const float u = rng.uniform4(i, 0, 0)[0];
    const std::array<float, 4> partner{rng.uniform4(i + 1, 0, 0)[0], rng.uniform4(i, 1, 0)[0],
                                       rng.uniform4(i, 0, 1)[0], other.uniform4(i, 0, 0)[0]};
    for (std::size_t k = 0; k < 4; ++k)
      counts[k][16 * static_cast<std::size_t>(u * 16) + static_cast<std::size_t>(partner[k] * 16)] += 1;
  }
  for (const auto& c : counts)
    EXPECT_GT(test::chi_square_of_counts(c, std::vector<double>(256, 100'000.0 / 256)), test::kFalseAlarm);
}

TEST(CounterRng, SameCounterSameNumbers) {
  EXPECT_EQ(CounterRng(9, RngPurpose::kPath).bits4(5, 6, 7), CounterRng(9, RngPurpose::kPath).bits4(5, 6, 7));
  EXPECT_NE(CounterRng(9, RngPurpose::kPath).bits4(5, 6, 7),
            CounterRng(10, RngPurpose::kPath).bits4(5, 6, 7));
}

TEST(Sobol, EveryDimensionIsStratified) {
  // Any aligned block of 2^m points has one point in each of 2^m strata of a dimension, scrambled or not.
  const SobolSequence sequence(77);
  for (int d = 0; d < kSobolDimensions; ++d)
    for (const std::uint32_t start : {0U, 1024U, 9U * 1024U}) {
      std::set<std::uint32_t> plain;
      std::set<int> scrambled;
      for (std::uint32_t i = start; i < start + 1024; ++i) {
        plain.insert(sobol_bits(i, d) >> 22);
        scrambled.insert(static_cast<int>(sequence.sample(i, d) * 1024));
      }
      EXPECT_EQ(plain.size(), 1024U) << "dimension " << d;
      EXPECT_EQ(scrambled.size(), 1024U) << "dimension " << d;
    }
}

TEST(Sobol, FirstTwoDimensionsFormANet) {
  // (0,2)-sequence: every elementary box of area 2^-8 holds exactly one of 256 aligned points.
  const SobolSequence sequence(5);
  for (int split = 0; split <= 8; ++split) {
    std::set<std::pair<int, int>> boxes;
    for (std::uint32_t i = 512; i < 768; ++i)
      boxes.insert({static_cast<int>(sequence.sample(i, 0) * static_cast<float>(1 << split)),
                    static_cast<int>(sequence.sample(i, 1) * static_cast<float>(1 << (8 - split)))});
    EXPECT_EQ(boxes.size(), 256U) << split;
  }
}

TEST(Sobol, BlocksOfSixteenEqualSinglePoints) {
  const SobolSequence sequence(123456789);
  float block[16];
  for (const std::uint32_t first : {0U, 16U, 4096U, 0xffffff0U})
    for (int d = 0; d < kSobolDimensions; ++d) {
      sequence.sample16(first, d, block);
      for (std::uint32_t i = 0; i < 16; ++i) EXPECT_EQ(block[i], sequence.sample(first + i, d));
    }
}

TEST(Sobol, ScramblingMakesEachPointUniform) {
  // One fixed point of the sequence over many scrambles: its mean over seeds is uniform in every dimension.
  std::vector<double> counts(16);
  for (std::uint64_t seed = 0; seed < 20'000; ++seed)
    counts[static_cast<std::size_t>(SobolSequence(seed * 7919).sample(3, 2) * 16)] += 1;
  EXPECT_GT(test::chi_square_of_counts(counts, std::vector<double>(16, 20'000.0 / 16)), test::kFalseAlarm);
}

}  // namespace
}  // namespace reemit
