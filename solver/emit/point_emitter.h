#pragma once
#include <cmath>
#include <numbers>

#include "scenes/model/luminaire.h"
#include "solver/emit/light_ray.h"
#include "solver/emit/luminaire_bounds.h"
#include "solver/emit/luminaire_sample.h"
#include "solver/sampling/warp.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Irradiance at x (unit normal n) of a point with unit intensity towards it [1/m2]: cos(theta) / r^2, times
/// share(away) for the unit direction from the point to x.
template <class Share>
float irradiance_of_point(const Vec3f& point, const Vec3f& x, const Vec3f& n, float square_metres_per_unit,
                          Share&& share) {
  const Vec3f to_light = point - x;
  const float distance2 = to_light.squaredNorm();
  const float height = n.dot(to_light);
  if (!(height > 0) || !(distance2 > 0)) return 0;
  const float distance = std::sqrt(distance2);
  return share(Vec3f(-to_light / distance)) * height / (distance * distance2) / square_metres_per_unit;
}

/// Square metres of one square unit of the normalised space.
inline float square_metres_per_unit(const RayTracer& rays) {
  const auto metres = static_cast<float>(rays.metres_per_unit());
  return metres * metres;
}

/// A point light in the normalised space, as PunctualEmitter asks every kind.
class PointEmitter {
 public:
  using Light = PointLight;
  static constexpr bool kAtInfinity = false;

  PointEmitter(const Light& light, const RayTracer& rays)
      : position_(rays.normalised(light.position)), metres2_(square_metres_per_unit(rays)) {}

  static const Spectrum& strength(const Light& light) { return light.intensity; }
  static Spectrum power(const Light& light, double /*metres_per_unit*/) {
    return 4 * std::numbers::pi * light.intensity;
  }

  float expected_irradiance(const Vec3f& x, const Vec3f& n) const {
    return irradiance_of_point(position_, x, n, metres2_, [](const Vec3f&) { return 1.0F; });
  }
  LuminaireSample sample(const Vec3f& x, const Vec3f& n, float /*u0*/, float /*u1*/) const {
    return {expected_irradiance(x, n), false, position_};
  }
  LuminaireBounds bounds(float strength) const { return sphere_bounds(position_, 0, strength); }
  Vec3f mouth() const { return position_; }
  LightRay start_ray(float /*u0*/, float /*u1*/, float u2, float u3) const {
    return {position_, sample_sphere(u2, u3)};
  }

 private:
  Vec3f position_;
  float metres2_;
};

}  // namespace reemit
