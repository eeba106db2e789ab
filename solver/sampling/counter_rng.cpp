#include "solver/sampling/counter_rng.h"

#include "scenes/model/instruction_sets.h"
#ifdef REEMIT_HAS_AVX512_FUNCTIONS
#include <immintrin.h>
#endif

namespace reemit {

#ifdef REEMIT_HAS_AVX512_FUNCTIONS
// Compilers make three multiplications out of one of 32 by 32 bits. Here each 64-bit lane holds a 32-bit
// number, what stands above it being ignored: those of even packets, and those of odd ones.
__attribute__((target("avx512f"))) void CounterRng::bits4x16_avx512(const std::uint32_t* index,
                                                                    std::uint32_t batch, std::uint32_t step,
                                                                    BitLanes& bits) const {
  using Lanes = std::uint64_t __attribute__((vector_size(64)));
  constexpr __mmask8 kAll = 0xff;
  const auto multiplier0 = reinterpret_cast<__m512i>(Lanes{} + kMultiplier0);
  const auto multiplier1 = reinterpret_cast<__m512i>(Lanes{} + kMultiplier1);
  const auto packets = reinterpret_cast<Lanes>(_mm512_loadu_si512(index));
  const Lanes all_batch = Lanes{} + batch;
  const Lanes all_step = Lanes{} + step;
  Lanes c[2][4] = {{packets, Lanes{}, all_batch, all_step}, {packets >> 32, Lanes{}, all_batch, all_step}};
  std::uint32_t k0 = key0_;
  std::uint32_t k1 = key1_;
#pragma GCC unroll 7
  for (int round = 0; round < 7; ++round) {
    for (auto& x : c) {
      const auto p0 =
          reinterpret_cast<Lanes>(_mm512_maskz_mul_epu32(kAll, reinterpret_cast<__m512i>(x[0]), multiplier0));
      const auto p1 =
          reinterpret_cast<Lanes>(_mm512_maskz_mul_epu32(kAll, reinterpret_cast<__m512i>(x[2]), multiplier1));
      x[0] = p1 >> 32 ^ x[1] ^ k0;
      x[1] = p1;
      x[2] = p0 >> 32 ^ x[3] ^ k1;
      x[3] = p0;
    }
    k0 += kWeyl0;
    k1 += kWeyl1;
  }
  for (int k = 0; k < 4; ++k)
    _mm512_store_si512(bits.word[k], reinterpret_cast<__m512i>((c[0][k] & 0xffffffffU) | c[1][k] << 32));
}
#endif

void CounterRng::bits4x16(const std::uint32_t* index, std::uint32_t batch, std::uint32_t step,
                          BitLanes& bits) const {
#ifdef REEMIT_HAS_AVX512_FUNCTIONS
  if (__builtin_cpu_supports("avx512f") != 0) {
    bits4x16_avx512(index, batch, step, bits);
    return;
  }
#endif
  bits4x16_anywhere(index, batch, step, bits);
}

REEMIT_FOR_INSTRUCTION_SETS
void CounterRng::bits4x16_anywhere(const std::uint32_t* __restrict index, std::uint32_t batch,
                                   std::uint32_t step, BitLanes& __restrict bits) const {
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
