#include "solver/emit/punctual_packets.h"

#include <numbers>
#include <variant>

#include "solver/emit/photometric_emitter.h"
#include "solver/emit/spot_distribution.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Radius of the sphere about the origin that holds the normalised room [-1,1]^3.
constexpr float kRoomRadius = 1.7320509F;

struct StartRay {
  const RayScene& scene;
  float u0, u1, u2, u3;
  Ray16& rays;
  int lane;

  void operator()(const PointLight& l) const {
    rays.set(lane, scene.normalised(l.position), sample_sphere(u2, u3));
  }
  void operator()(const SpotLight& l) const {
    const Frame frame(l.direction.cast<float>());
    rays.set(lane, scene.normalised(l.position), frame.to_world(SpotDistribution(l).sample(u2, u3)));
  }
  void operator()(const DirectionalLight& l) const {
    const Frame frame(l.direction.cast<float>());
    const Point2 d = sample_disk(u0, u1);
    const Vec3f origin = kRoomRadius * (d.x * frame.tangent + d.y * frame.bitangent - 1.01F * frame.normal);
    rays.set(lane, origin, frame.normal);
  }
  void operator()(const PhotometricLight& l) const {
    Vec3f origin;
    Vec3f direction;
    start_photometric_ray(l, scene, u0, u1, u2, u3, origin, direction);
    rays.set(lane, origin, direction);
  }
};

struct Power {
  const RayScene& scene;
  Spectrum operator()(const PointLight& l) const { return 4 * std::numbers::pi * l.intensity; }
  Spectrum operator()(const SpotLight& l) const { return SpotDistribution(l).solid_angle() * l.intensity; }
  Spectrum operator()(const DirectionalLight& l) const {
    const double radius = kRoomRadius * scene.metres_per_unit();
    return std::numbers::pi * radius * radius * l.irradiance;
  }
  Spectrum operator()(const PhotometricLight& l) const {
    return l.table->total_flux() * l.intensity_per_candela;
  }
};

}  // namespace

void start_light_ray(const PunctualLight& light, const RayScene& scene, float u0, float u1, float u2,
                     float u3, Ray16& rays, int lane) {
  std::visit(StartRay{scene, u0, u1, u2, u3, rays, lane}, light);
}

Spectrum light_power(const PunctualLight& light, const RayScene& scene) {
  return std::visit(Power{scene}, light);
}

}  // namespace reemit
