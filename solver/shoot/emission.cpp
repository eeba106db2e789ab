#include "solver/shoot/emission.h"

#include <cmath>
#include <numbers>

#include "solver/emit/photometric_emitter.h"
#include "solver/emit/spot_distribution.h"

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

Emission collect_emission(const TransportScene& transport) {
  const ZoneMesh& mesh = transport.mesh();
  const Scene& scene = transport.scene();
  const std::size_t bands = transport.bands();
  Emission emission;
  std::vector<double> watts;  // [source * bands + band]
  const auto add = [&](EmissionSource source, const Spectrum& power) {
    if (!(power > 0).any()) return;
    emission.sources.push_back(source);
    watts.insert(watts.end(), power.begin(), power.end());
  };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId id(t);
    const BaseTriangle& triangle = mesh.triangle(id);
    const Material& material = scene.material_of(scene.surfaces[triangle.surface.index()]);
    if (!material.emits()) continue;
    const std::size_t per_side = std::size_t{triangle.divisions} * triangle.divisions;
    const Spectrum power = mesh.triangle_area(id) / static_cast<double>(per_side) * material.exitance();
    const auto exponent = static_cast<float>(material.emission_exponent);
    for (const bool front : {true, false}) {
      if (!front && !(material.emits_both_sides && triangle.two_sided)) continue;
      const std::size_t first = mesh.first_zone(id, front).index();
      for (std::size_t z = 0; z < per_side; ++z) add({ZoneId(first + z), 0, exponent}, power);
    }
  }
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    add({ZoneId(), static_cast<std::uint32_t>(l), 0}, light_power(scene.lights[l], transport.rays()));

  const std::size_t count = emission.sources.size();
  emission.quanta.assign(count * bands, 0);
  emission.watts.assign(bands, 0);
  emission.watts_per_quantum.assign(bands, 0);
  for (std::size_t b = 0; b < bands; ++b) {
    double& total = emission.watts[b];
    for (std::size_t s = 0; s < count; ++s) total += watts[s * bands + b];
    if (!(total > 0)) continue;
    emission.watts_per_quantum[b] = total / static_cast<double>(kBatchQuanta);
    // Rounding the running sum, not the terms, makes the quanta add up exactly.
    double running = 0;
    std::int64_t given = 0;
    for (std::size_t s = 0; s < count; ++s) {
      running += watts[s * bands + b];
      const std::int64_t until =
          s + 1 == count ? kBatchQuanta : std::llround(running / total * static_cast<double>(kBatchQuanta));
      emission.quanta[s * bands + b] = until - given;
      given = until;
    }
  }
  return emission;
}

}  // namespace reemit
