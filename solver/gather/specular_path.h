#pragma once
#include <cmath>
#include <cstdint>

#include "solver/gather/path_key.h"
#include "solver/reflect/surface_model.h"
#include "solver/sampling/counter_rng.h"

namespace reemit {

/// Uniform numbers that choose the ways of one path on mirrors and glass.
class SpecularNumbers {
 public:
  SpecularNumbers(std::uint64_t seed, RngPurpose purpose) : rng_(seed, purpose) {}

  static constexpr std::uint32_t kMostSteps = 4 * PathKey::kStepsPerPath;  ///< Paths end there.
  /// In [0,1). Pre: step < kMostSteps.
  float at(const PathKey& key, std::uint32_t step) const {
    return rng_.uniform4(key.index, key.batch, key.step(step / 4))[step % 4];
  }

 private:
  CounterRng rng_;
};

/// Adds weight[b] times the radiance that x emits towards x.towards to sum[b].
inline void add_emission(const SurfaceModel& surfaces, const SurfacePoint& x, const float* weight,
                         float* sum) {
  if (!surfaces.emits(x.triangle, x.front)) return;
  const float* emitted = surfaces.emitted(x.triangle, x.front);
  const float shape = surfaces.emission_shape(x.triangle, std::fabs(x.normal.dot(x.towards)));
  for (std::size_t b = 0; b < surfaces.band_count(); ++b) sum[b] += weight[b] * shape * emitted[b];
}

}  // namespace reemit
