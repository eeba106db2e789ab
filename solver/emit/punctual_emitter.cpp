#include "solver/emit/punctual_emitter.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace reemit {

float PunctualEmitter::falloff(const Vec3f& away) const {
  if (kind != Kind::kSpot) return 1;
  const float linear = std::clamp(direction.dot(away) * angle_scale + angle_offset, 0.0F, 1.0F);
  return linear * linear;
}

float PunctualEmitter::unoccluded_irradiance(const Vec3f& x, const Vec3f& n, float metres_per_unit) const {
  if (kind == Kind::kDirectional) return std::max(0.0F, -direction.dot(n));
  const Vec3f to_light = position - x;
  const float distance2 = to_light.squaredNorm();
  const float height = n.dot(to_light);
  if (!(height > 0) || !(distance2 > 0)) return 0;
  const float distance = std::sqrt(distance2);
  return falloff(-to_light / distance) * height / (distance * distance2) /
         (metres_per_unit * metres_per_unit);
}

PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayScene& rays) {
  PunctualEmitter emitter;
  if (const auto* point = std::get_if<PointLight>(&light)) {
    emitter.kind = PunctualEmitter::Kind::kPoint;
    emitter.position = rays.normalised(point->position);
  } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
    emitter.kind = PunctualEmitter::Kind::kSpot;
    emitter.position = rays.normalised(spot->position);
    emitter.direction = spot->direction.cast<float>();
    const double cos_outer = std::cos(spot->outer_angle);
    const double scale = 1 / std::max(0.001, std::cos(spot->inner_angle) - cos_outer);
    emitter.angle_scale = static_cast<float>(scale);
    emitter.angle_offset = static_cast<float>(-cos_outer * scale);
  } else {
    emitter.kind = PunctualEmitter::Kind::kDirectional;
    emitter.direction = std::get<DirectionalLight>(light).direction.cast<float>();
  }
  return emitter;
}

const Spectrum& emission_of(const PunctualLight& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) return point->intensity;
  if (const auto* spot = std::get_if<SpotLight>(&light)) return spot->intensity;
  return std::get<DirectionalLight>(light).irradiance;
}

}  // namespace reemit
