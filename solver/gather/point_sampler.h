#pragma once
#include <array>
#include <cstdint>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"

namespace reemit {

/// One of the pixels or vertices that share sequences.
struct AmongNeighbours {
  std::uint64_t group;   ///< That it belongs to.
  std::uint32_t number;  ///< In the group; those that follow each other lie side by side.
  int log2_count;        ///< Of the numbers of a group.
};

/// The uniform numbers of one replicate of one pixel or vertex: randomised Sobol' points, scrambled afresh
/// for every one of them, so that neighbours share no pattern and replicates are independent. More samples of
/// a replicate continue its sequences. Place, luminaires and hemisphere have sequences of their own whose
/// order is shuffled against each other.
class PointSampler {
 public:
  /// `index`: of the pixel or vertex. `log2_samples`: samples 0 .. 2^log2_samples - 1 may be asked for
  /// [0,32).
  PointSampler(std::uint64_t seed, RngPurpose purpose, std::uint64_t index, int replicate, int log2_samples)
      : PointSampler(CounterRng(seed, purpose), index, static_cast<std::uint32_t>(replicate), log2_samples) {}

  /// The sequences of a group, of which each member has an aligned block: its points are as even as those of
  /// sequences of its own, and those of neighbours fill each other's gaps, so that means over neighbours have
  /// less noise ([AW20] sec. 3). Pre: log2_samples + log2_count < 32.
  PointSampler(std::uint64_t seed, RngPurpose purpose, const AmongNeighbours& place, int replicate,
               int log2_samples)
      : PointSampler(seed, purpose, place.group, replicate, log2_samples + place.log2_count) {
    first_ = place.number << log2_samples;
  }

  /// Where a sample lies: on the film, or around the vertex.
  std::array<float, 2> place(int sample) const {
    const std::uint32_t i = first_ + static_cast<std::uint32_t>(sample);
    return {place_.sample(i, 0), place_.sample(i, 1)};
  }
  /// Shadow ray `ray` of `rays` of a sample.
  std::array<float, 3> light(int sample, int ray, int rays) const {
    const std::uint32_t i = position(sample, light_shuffle_, ray, rays);
    return {light_.sample(i, 0), light_.sample(i, 1), light_.sample(i, 2)};
  }
  /// The ray of a sample that is aimed at a bright zone.
  std::array<float, 3> bright(int sample) const {
    const std::uint32_t i = position(sample, bright_shuffle_, 0, 1);
    return {bright_.sample(i, 0), bright_.sample(i, 1), bright_.sample(i, 2)};
  }
  /// Gather ray `ray` of `rays` of a sample.
  std::array<float, 2> hemisphere(int sample, int ray, int rays) const {
    const std::uint32_t i = position(sample, hemisphere_shuffle_, ray, rays);
    return {hemisphere_.sample(i, 0), hemisphere_.sample(i, 1)};
  }

 private:
  PointSampler(const CounterRng& rng, std::uint64_t index, std::uint32_t replicate, int log2_samples)
      : PointSampler(rng.bits4(index, replicate, 0), rng.bits4(index, replicate, 1),
                     rng.bits4(index, replicate, 2), log2_samples) {}
  PointSampler(const std::array<std::uint32_t, 4>& a, const std::array<std::uint32_t, 4>& b,
               const std::array<std::uint32_t, 4>& c, int log2_samples)
      : place_(join(a[0], a[1])),
        light_(join(a[2], a[3])),
        hemisphere_(join(b[0], b[1])),
        bright_(join(c[0], c[1])),
        light_shuffle_(b[2]),
        hemisphere_shuffle_(b[3]),
        bright_shuffle_(c[2]),
        free_bits_(32 - log2_samples) {}

  static std::uint64_t join(std::uint32_t high, std::uint32_t low) {
    return (std::uint64_t{high} << 32) | low;
  }
  /// Nested uniform shuffle of the samples [BUR20, sec. 4]: keeps every aligned block together.
  std::uint32_t position(int sample, std::uint32_t shuffle, int ray, int rays) const {
    std::uint32_t i = 0;
    if (free_bits_ < 32)
      i = owen_scramble((first_ + static_cast<std::uint32_t>(sample)) << free_bits_, shuffle) >> free_bits_;
    return i * static_cast<std::uint32_t>(rays) + static_cast<std::uint32_t>(ray);
  }

  SobolSequence place_, light_, hemisphere_, bright_;
  std::uint32_t light_shuffle_, hemisphere_shuffle_, bright_shuffle_;
  int free_bits_;
  std::uint32_t first_ = 0;
};

}  // namespace reemit
