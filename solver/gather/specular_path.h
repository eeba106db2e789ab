#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "solver/gather/caustic_map.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/path_key.h"
#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"

namespace reemit {

/// Uniform numbers that choose the ways of one path on mirrors, gloss and glass.
class SpecularNumbers {
 public:
  SpecularNumbers(std::uint64_t seed, RngPurpose choice, RngPurpose spread)
      : rng_(seed, choice), spread_(seed, spread) {}

  static constexpr std::uint32_t kMostSteps = 4 * PathKey::kStepsPerPath;  ///< Paths end there.
  /// In [0,1). Pre: step < kMostSteps.
  float at(const PathKey& key, std::uint32_t step) const {
    return rng_.uniform4(key.index, key.batch, key.step(step / 4))[step % 4];
  }
  /// Two numbers in [0,1) that spread a way on; they come again after PathKey::kStepsPerPath steps.
  std::array<float, 2> spread(const PathKey& key, std::uint32_t step) const {
    const std::array<float, 4> u =
        spread_.uniform4(key.index, key.batch, key.step(step % PathKey::kStepsPerPath));
    return {u[0], u[1]};
  }

 private:
  CounterRng rng_;
  CounterRng spread_;
};

/// A path that is followed over mirrors, gloss and glass: what it came over since light was scattered last,
/// and where it goes on. Of one thread.
class SpecularPath {
 public:
  enum class Next { kScatters, kGoesOn, kEnds };

  /// `pdf_per_sr`: density of the first ray, where it leaves a surface whose light of luminaires is divided
  /// between shadow rays and such rays (DirectLight::found_by_lobe); else 0.
  /// `caustic`: what it is to count until light is scattered.
  SpecularPath(const Room& room, const SpecularNumbers& numbers, const PathKey& key,
               const CausticShare& caustic = {}, float pdf_per_sr = 0)
      : room_(&room),
        numbers_(&numbers),
        caustic_(caustic),
        key_(key),
        step_(room.surfaces().any_specular() ? room.band_count() : 0),
        pdf_per_sr_(pdf_per_sr) {}

  /// Goes to a hit: takes from weight[b] what a body of glass absorbed on the way, and adds weight[b] times
  /// what the hit emits back along it to sum[b], as far as shadow rays from where light was scattered last
  /// did not find it.
  void arrive(const DirectLight& direct, const Hit& hit, const Vec3f& along, float* weight, float* sum) {
    const SurfaceModel& surfaces = room_->surfaces();
    way_ += hit.distance;
    surfaces.attenuate(surfaces.body_around(hit.triangle, hit.front, body_), hit.distance, weight);
    if (!(is_bent_ || pdf_per_sr_ > 0) || !surfaces.emits(hit.triangle, hit.front)) return;
    const float found = (is_bent_ ? 1 : direct.found_by_lobe(hit.triangle, way_, pdf_per_sr_)) *
                        counted().of(surfaces.surface(hit.triangle, hit.front));
    const SurfacePoint x = surface_point(room_->rays(), hit, along);
    SurfaceModel::PointValues at_point;
    const float* emitted = surfaces.emitted(x, at_point);
    const float shape = found * surfaces.emission_shape(x.triangle, std::fabs(x.normal.dot(x.towards)));
    const float* there = of_light_there(weight);
    for (std::size_t b = 0; b < surfaces.band_count(); ++b) sum[b] += there[b] * shape * emitted[b];
  }
  /// Leaves the room: adds weight[b] times what of sky and sun it meets to sum[b], as far as shadow rays from
  /// where light was scattered last did not find it.
  void leave(const Vec3f& along, const float* weight, float* sum) {
    const SkyLight* sky = room_->sky();
    if (sky == nullptr || !(is_bent_ || pdf_per_sr_ > 0)) return;
    const float* there = of_light_there(weight);
    const float found = is_bent_ ? 1 : sky->sky_found_by_lobe(along, pdf_per_sr_);
    const float* radiance = sky->radiance(along);
    for (std::size_t b = 0; b < room_->band_count(); ++b) sum[b] += there[b] * found * radiance[b];
    const float* sun = sky->sun_radiance(along);
    if (sun == nullptr) return;
    const float found_of_sun =
        (is_bent_ ? 1 : sky->sun_found_by_lobe(pdf_per_sr_)) * counted().of(SurfaceId());
    for (std::size_t b = 0; b < room_->band_count(); ++b) sum[b] += there[b] * found_of_sun * sun[b];
  }
  /// weight[b] for light that starts at the last hit, whose radiance is less where that is inside of glass
  /// (SurfaceModel::radiance_outside). To be used until the next call.
  const float* of_light_there(const float* weight) {
    const float outside = room_->surfaces().radiance_outside(body_);
    if (outside == 1) return weight;
    there_.assign(weight, weight + room_->band_count());
    for (float& w : there_) w *= outside;
    return there_.data();
  }
  /// What of light over mirrors, glass and gloss to where it was scattered last this path is to count.
  CausticShare counted() const { return is_wide_ ? CausticShare{} : caustic_; }
  /// What becomes of the path at x, a surface that sends rays on. It scatters with the chance `scattered`
  /// [0,1], which is lowered where it and the ways on add up to more than 1; or it goes on, from origin()
  /// along direction(), with weight[b] for that.
  Next choose(const SurfacePoint& x, DiffuseWay diffuse, float& scattered, float* weight) {
    if (steps_ == SpecularNumbers::kMostSteps) return Next::kEnds;
    const SpecularSurface& surface = room_->surfaces().specular(x.triangle);
    step_.diffuse_way = diffuse;
    const float on = surface.shares(x.normal.dot(x.towards), x.front, step_);
    if (scattered + on > 1) scattered /= scattered + on;
    const float u = numbers_->at(key_, steps_);
    std::array<float, 2> spread{};
    if (surface.is_spread()) spread = numbers_->spread(key_, steps_);
    ++steps_;
    if (u < scattered) return Next::kScatters;
    if (!surface.choose(x, u - scattered, spread, Survival::kRoulette, step_, 1 - scattered))
      return Next::kEnds;
    for (std::size_t b = 0; b < room_->band_count(); ++b) weight[b] *= step_.share()[b] / step_.chance;
    is_wide_ = is_wide_ || step_.is_wide;
    if (step_.way == SpecularWayOn::kDiffuse) {
      // Photons on the other side have been asked for.
      is_scattered_ = true;
      is_wide_ = false;
      leave_rest_to_photons();
    }
    if (step_.pdf_per_sr > 0) {
      is_bent_ = false;
      pdf_per_sr_ = step_.pdf_per_sr;
      way_ = 0;
    } else {
      is_bent_ = is_bent_ || step_.bends;
    }
    body_ = room_->surfaces().body_beyond(x.triangle, step_.front, body_);
    origin_ = room_->rays().ray_origin(x.triangle, x.u, x.v, step_.front);
    return Next::kGoesOn;
  }
  const Vec3f& origin() const { return origin_; }
  const Vec3f& direction() const { return step_.direction; }
  /// Light is scattered here: what comes next is seen by shadow rays again.
  void scatter() {
    is_bent_ = is_wide_ = false;
    pdf_per_sr_ = 0;
    leave_rest_to_photons();
    is_scattered_ = true;
  }
  /// Whether light was scattered into all directions on the way: what it comes over next is no caustic.
  bool is_scattered() const { return is_scattered_; }

 private:
  void leave_rest_to_photons() {
    caustic_.none = true;
    caustic_.all = false;
  }

  const Room* room_;
  const SpecularNumbers* numbers_;
  CausticShare caustic_;
  PathKey key_;
  SpecularStep step_;
  bool is_wide_ = false;  // it came over a wide lobe
  bool is_scattered_ = false;
  bool is_bent_ = false;     // shadow rays do not find what it meets
  float pdf_per_sr_;         // of the ray that left a lobe last; 0 where none did
  float way_ = 0;            // from there
  std::uint32_t steps_ = 0;  // in all
  TriangleId body_;          // of glass that the path was sent into
  std::vector<float> there_;
  Vec3f origin_{0, 0, 0};
};

}  // namespace reemit
