#pragma once
#include <algorithm>
#include <numbers>

#include "scenes/model/luminaire.h"
#include "solver/emit/light_ray.h"
#include "solver/emit/luminaire_sample.h"
#include "solver/sampling/warp.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Light from infinitely far away, as PunctualEmitter asks every kind. Its power is that of the beam that
/// holds the room.
class DirectionalEmitter {
 public:
  using Light = DirectionalLight;
  static constexpr bool kAtInfinity = true;

  DirectionalEmitter(const Light& light, const RayTracer& /*rays*/)
      : direction_(light.direction.cast<float>()) {}

  static const Spectrum& strength(const Light& light) { return light.irradiance; }
  static Spectrum power(const Light& light, double metres_per_unit) {
    const double radius = kRoomRadius * metres_per_unit;
    return std::numbers::pi * radius * radius * light.irradiance;
  }

  float expected_irradiance(const Vec3f& /*x*/, const Vec3f& n) const {
    return std::max(0.0F, -direction_.dot(n));
  }
  LuminaireSample sample(const Vec3f& x, const Vec3f& n, float /*u0*/, float /*u1*/) const {
    return {expected_irradiance(x, n), true, -direction_};
  }
  LightRay start_ray(float u0, float u1, float /*u2*/, float /*u3*/) const {
    const Frame frame(direction_);
    const Point2 d = sample_disk(u0, u1);
    return {kRoomRadius * (d.x * frame.tangent + d.y * frame.bitangent - 1.01F * frame.normal), frame.normal};
  }

 private:
  /// Radius of the sphere about the origin that holds the normalised room [-1,1]^3.
  static constexpr float kRoomRadius = 1.7320509F;

  Vec3f direction_;  // unit, the way the light travels
};

}  // namespace reemit
