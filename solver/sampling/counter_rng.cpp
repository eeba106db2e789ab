#include "solver/sampling/counter_rng.h"

#include "scenes/model/instruction_sets.h"

namespace reemit {

REEMIT_FOR_INSTRUCTION_SETS
void CounterRng::bits4x16(const std::uint32_t* __restrict index, std::uint32_t batch, std::uint32_t step,
                          BitLanes& __restrict bits) const {
  for (int i = 0; i < 16; ++i) {
    std::uint32_t c0 = index[i];
    std::uint32_t c1 = 0;
    std::uint32_t c2 = batch;
    std::uint32_t c3 = step;
    std::uint32_t k0 = key0_;
    std::uint32_t k1 = key1_;
#pragma GCC unroll 7
    for (int round = 0; round < 7; ++round) {
      const std::uint32_t high0 = static_cast<std::uint32_t>((std::uint64_t{kMultiplier0} * c0) >> 32);
      const std::uint32_t high1 = static_cast<std::uint32_t>((std::uint64_t{kMultiplier1} * c2) >> 32);
      const std::uint32_t low0 = kMultiplier0 * c0;
      const std::uint32_t low1 = kMultiplier1 * c2;
      c0 = high1 ^ c1 ^ k0;
      c1 = low1;
      c2 = high0 ^ c3 ^ k1;
      c3 = low0;
      k0 += kWeyl0;
      k1 += kWeyl1;
    }
    bits.word[0][i] = c0;
    bits.word[1][i] = c1;
    bits.word[2][i] = c2;
    bits.word[3][i] = c3;
  }
}

}  // namespace reemit
