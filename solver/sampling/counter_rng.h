#pragma once
#include <array>
#include <cstdint>

namespace reemit {

/// What a stream of random numbers is for; numbers of different purposes never coincide. Results depend on
/// the numbers beside the names: a new purpose takes the next one, and none is ever given to another.
enum class RngPurpose : std::uint32_t {
  kEmission = 1,
  kReflection = 2,
  kAllocation = 3,
  kScramble = 4,
  kHemisphere = 6,
  kPixel = 7,
  kPath = 8,
  kProbe = 9,
  kDither = 10,
  kSmallZone = 11,
  kSmallZonePilot = 12,
  kDiscretisation = 13,
  kFormFactor = 14,
  kDirectAudit = 15,
  kUnevenZone = 16,
  kZoneBias = 17,
  kArrival = 18,
  kSealedSides = 19,
  kPilotLight = 21,
  kSpecular = 22,
  kSpecularCamera = 23,
  kSpread = 24,
  kSpreadCamera = 25,
  kCaustic = 26,
  kSeenLight = 27,
  kSkySurvey = 28,
  kSampledDirect = 29,
  kPixelGroup = 30,
  kVertexGroup = 31,
  kMeasuringPoint = 32,
  kAimGain = 33,
  kOpenRoom = 34,
  kDarkSpace = 35,
  kClosedRoom = 36,
};

/// Four 32-bit numbers of each of 16 packets: word[k][lane].
struct alignas(64) BitLanes {
  std::uint32_t word[4][16];
};

/// Counter-based random numbers: Philox4x32 with 7 rounds, the fewest that pass BigCrush [SMDS11, table 2]. A
/// number is a function of (seed, purpose, batch, index, step): no state, no order, the same on any number of
/// threads.
class CounterRng {
 public:
  CounterRng(std::uint64_t seed, RngPurpose purpose)
      : key0_(static_cast<std::uint32_t>(seed) ^ (static_cast<std::uint32_t>(purpose) * 0x9E3779B9U)),
        key1_(static_cast<std::uint32_t>(seed >> 32) + static_cast<std::uint32_t>(purpose)) {}

  /// Four independent 32-bit numbers.
  std::array<std::uint32_t, 4> bits4(std::uint64_t index, std::uint32_t batch, std::uint32_t step) const {
    std::uint32_t c0 = static_cast<std::uint32_t>(index);
    std::uint32_t c1 = static_cast<std::uint32_t>(index >> 32);
    std::uint32_t c2 = batch;
    std::uint32_t c3 = step;
    std::uint32_t k0 = key0_;
    std::uint32_t k1 = key1_;
    for (int round = 0; round < 7; ++round) {
      const std::uint64_t p0 = std::uint64_t{kMultiplier0} * c0;
      const std::uint64_t p1 = std::uint64_t{kMultiplier1} * c2;
      c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ k0;
      c1 = static_cast<std::uint32_t>(p1);
      c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ k1;
      c3 = static_cast<std::uint32_t>(p0);
      k0 += kWeyl0;
      k1 += kWeyl1;
    }
    return {c0, c1, c2, c3};
  }

  /// The same for 16 indices at once: bits.word[k][i] = bits4(index[i], batch, step)[k].
  void bits4x16(const std::uint32_t* index, std::uint32_t batch, std::uint32_t step, BitLanes& bits) const;
  /// The same with instructions that every processor has.
  void bits4x16_anywhere(const std::uint32_t* index, std::uint32_t batch, std::uint32_t step,
                         BitLanes& bits) const;

  /// Four independent uniform numbers in [0,1).
  std::array<float, 4> uniform4(std::uint64_t index, std::uint32_t batch, std::uint32_t step) const {
    const auto b = bits4(index, batch, step);
    return {to_unit(b[0]), to_unit(b[1]), to_unit(b[2]), to_unit(b[3])};
  }

  /// Uniform in [0,1) with 24 bits: never rounds up to 1.
  static float to_unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

 private:
  /// For processors that have AVX-512.
  void bits4x16_avx512(const std::uint32_t* index, std::uint32_t batch, std::uint32_t step,
                       BitLanes& bits) const;

  static constexpr std::uint32_t kMultiplier0 = 0xD2511F53U;
  static constexpr std::uint32_t kMultiplier1 = 0xCD9E8D57U;
  static constexpr std::uint32_t kWeyl0 = 0x9E3779B9U;
  static constexpr std::uint32_t kWeyl1 = 0xBB67AE85U;

  std::uint32_t key0_;
  std::uint32_t key1_;
};

}  // namespace reemit
