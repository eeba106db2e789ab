#include "solver/sampling/counter_rng.h"

namespace reemit {

// Integer arithmetic only: all versions return the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void CounterRng::bits4x16(const std::uint32_t index[16], std::uint32_t batch, std::uint32_t step,
                          std::uint32_t out[4][16]) const {
  std::uint32_t c0[16];
  std::uint32_t c1[16];
  std::uint32_t c2[16];
  std::uint32_t c3[16];
  for (int i = 0; i < 16; ++i) {
    c0[i] = index[i];
    c1[i] = 0;
    c2[i] = batch;
    c3[i] = step;
  }
  std::uint32_t k0 = key0_;
  std::uint32_t k1 = key1_;
  for (int round = 0; round < 7; ++round) {
    for (int i = 0; i < 16; ++i) {
      const std::uint64_t p0 = std::uint64_t{kMultiplier0} * c0[i];
      const std::uint64_t p1 = std::uint64_t{kMultiplier1} * c2[i];
      c0[i] = static_cast<std::uint32_t>(p1 >> 32) ^ c1[i] ^ k0;
      c1[i] = static_cast<std::uint32_t>(p1);
      c2[i] = static_cast<std::uint32_t>(p0 >> 32) ^ c3[i] ^ k1;
      c3[i] = static_cast<std::uint32_t>(p0);
    }
    k0 += kWeyl0;
    k1 += kWeyl1;
  }
  for (int i = 0; i < 16; ++i) {
    out[0][i] = c0[i];
    out[1][i] = c1[i];
    out[2][i] = c2[i];
    out[3][i] = c3[i];
  }
}

}  // namespace reemit
