#pragma once
#include <algorithm>
#include <cmath>

#include "solver/emit/point_emitter.h"
#include "solver/emit/spot_distribution.h"

namespace reemit {

/// A spot in the normalised space, as PunctualEmitter asks every kind.
class SpotEmitter {
 public:
  using Light = SpotLight;
  static constexpr bool kAtInfinity = false;

  SpotEmitter(const Light& light, const RayTracer& rays)
      : position_(rays.normalised(light.position)),
        direction_(light.direction.cast<float>()),
        metres2_(square_metres_per_unit(rays)),
        cos_outer_(static_cast<float>(std::max(0.0, std::cos(light.outer_angle)))),
        distribution_(light) {}

  static const Spectrum& strength(const Light& light) { return light.intensity; }
  static Spectrum power(const Light& light, double /*metres_per_unit*/) {
    return SpotDistribution(light).solid_angle() * light.intensity;
  }

  float expected_irradiance(const Vec3f& x, const Vec3f& n) const {
    return irradiance_of_point(position_, x, n, metres2_,
                               [this](const Vec3f& away) { return distribution_.share(direction_, away); });
  }
  LuminaireSample sample(const Vec3f& x, const Vec3f& n, float /*u0*/, float /*u1*/) const {
    return {expected_irradiance(x, n), false, position_};
  }
  LuminaireBounds bounds(float strength) const {
    return spot_bounds(position_, direction_, cos_outer_, strength);
  }
  Vec3f mouth() const { return position_; }
  LightRay start_ray(float /*u0*/, float /*u1*/, float u2, float u3) const {
    return {position_, Frame(direction_).to_world(distribution_.sample(u2, u3))};
  }

 private:
  Vec3f position_;
  Vec3f direction_;  // unit, the way the light travels
  float metres2_;
  float cos_outer_;
  SpotDistribution distribution_;
};

}  // namespace reemit
