#pragma once
#include <cmath>
#include <cstdint>

#include "solver/gather/path_key.h"
#include "solver/room/room.h"
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

/// A path that is followed over mirrors and glass: what it came over since light was scattered last, and
/// where it goes on. Of one thread.
class SpecularPath {
 public:
  enum class Next { kScatters, kGoesOn, kEnds };

  SpecularPath(const Room& room, const SpecularNumbers& numbers, const PathKey& key)
      : room_(&room),
        numbers_(&numbers),
        key_(key),
        step_(room.surfaces().any_specular() ? room.band_count() : 0) {}

  /// Whether shadow rays from where light was scattered last did not find what the path meets now.
  bool is_bent() const { return is_bent_; }
  /// Takes from weight[b] what a body of glass absorbed on the way to a hit.
  void attenuate(const Hit& hit, float* weight) const {
    const SurfaceModel& surfaces = room_->surfaces();
    surfaces.attenuate(surfaces.body_around(hit.triangle, hit.front, body_), hit.distance, weight);
  }
  /// What becomes of the path at x, a mirror or glass. It scatters with the chance `scattered` [0,1], which
  /// is lowered where it and the ways on add up to more than 1; or it goes on, from origin() along
  /// direction(), with weight[b] for that.
  Next choose(const SurfacePoint& x, float& scattered, float* weight) {
    if (steps_ == SpecularNumbers::kMostSteps) return Next::kEnds;
    const SpecularSurface& surface = room_->surfaces().specular(x.triangle);
    const float on = surface.shares(x.normal.dot(x.towards), x.front, step_);
    if (scattered + on > 1) scattered /= scattered + on;
    const float u = numbers_->at(key_, steps_++);
    if (u < scattered) return Next::kScatters;
    if (!surface.choose(x, u - scattered, Survival::kRoulette, step_, 1 - scattered)) return Next::kEnds;
    for (std::size_t b = 0; b < room_->band_count(); ++b) weight[b] *= step_.share()[b] / step_.chance;
    is_bent_ = is_bent_ || step_.bends;
    body_ = room_->surfaces().body_beyond(x.triangle, step_.front, body_);
    origin_ = room_->rays().ray_origin(x.triangle, x.u, x.v, step_.front);
    return Next::kGoesOn;
  }
  const Vec3f& origin() const { return origin_; }
  const Vec3f& direction() const { return step_.direction; }
  /// Light is scattered here: what comes next is seen by shadow rays again.
  void scatter() { is_bent_ = false; }

 private:
  const Room* room_;
  const SpecularNumbers* numbers_;
  PathKey key_;
  SpecularStep step_;
  bool is_bent_ = false;
  std::uint32_t steps_ = 0;  // over mirrors and panes in all
  TriangleId body_;          // of glass that the path was sent into
  Vec3f origin_{0, 0, 0};
};

}  // namespace reemit
