#include "solver/emit/punctual_emitter.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace reemit {
namespace {

struct MakeEmitter {
  const RayScene& rays;

  PunctualEmitter operator()(const PointLight& l) const {
    PunctualEmitter emitter;
    emitter.kind = PunctualEmitter::Kind::kPoint;
    emitter.position = rays.normalised(l.position);
    return emitter;
  }
  PunctualEmitter operator()(const SpotLight& l) const {
    PunctualEmitter emitter;
    emitter.kind = PunctualEmitter::Kind::kSpot;
    emitter.position = rays.normalised(l.position);
    emitter.direction = l.direction.cast<float>();
    emitter.spot.emplace(l);
    return emitter;
  }
  PunctualEmitter operator()(const DirectionalLight& l) const {
    PunctualEmitter emitter;
    emitter.kind = PunctualEmitter::Kind::kDirectional;
    emitter.direction = l.direction.cast<float>();
    return emitter;
  }
  PunctualEmitter operator()(const PhotometricLight& l) const {
    PunctualEmitter emitter;
    emitter.kind = PunctualEmitter::Kind::kPhotometric;
    emitter.position = rays.normalised(l.position);
    emitter.photometric = std::make_shared<const PhotometricEmitter>(l, rays);
    return emitter;
  }
};

struct EmissionOf {
  const Spectrum& operator()(const PointLight& l) const { return l.intensity; }
  const Spectrum& operator()(const SpotLight& l) const { return l.intensity; }
  const Spectrum& operator()(const DirectionalLight& l) const { return l.irradiance; }
  const Spectrum& operator()(const PhotometricLight& l) const { return l.intensity_per_candela; }
};

}  // namespace

float PunctualEmitter::unoccluded_irradiance(const Vec3f& x, const Vec3f& n, float metres_per_unit) const {
  if (kind == Kind::kDirectional) return std::max(0.0F, -direction.dot(n));
  if (kind == Kind::kPhotometric) return photometric->expected_irradiance(x, n);
  const Vec3f to_light = position - x;
  const float distance2 = to_light.squaredNorm();
  const float height = n.dot(to_light);
  if (!(height > 0) || !(distance2 > 0)) return 0;
  const float distance = std::sqrt(distance2);
  const float share = kind == Kind::kSpot ? spot->share(direction, -to_light / distance) : 1;
  return share * height / (distance * distance2) / (metres_per_unit * metres_per_unit);
}

PunctualSample PunctualEmitter::sample(const Vec3f& x, const Vec3f& n, float u0, float u1,
                                       float metres_per_unit) const {
  if (kind == Kind::kPhotometric) return photometric->sample(x, n, u0, u1);
  const bool far = kind == Kind::kDirectional;
  return {unoccluded_irradiance(x, n, metres_per_unit), far, far ? Vec3f(-direction) : position};
}

PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayScene& rays) {
  return std::visit(MakeEmitter{rays}, light);
}

const Spectrum& emission_of(const PunctualLight& light) {
  return std::visit(EmissionOf{}, light);
}

}  // namespace reemit
