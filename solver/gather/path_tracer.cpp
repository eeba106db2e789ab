#include "solver/gather/path_tracer.h"

#include <algorithm>

#include "solver/reflect/lambert.h"

namespace reemit {

PathTracer::PathTracer(const Room& room, const DirectLight& direct, std::uint64_t seed)
    : room_(&room),
      direct_(&direct),
      rng_(seed, RngPurpose::kPath),
      specular_(seed, RngPurpose::kSpecular, RngPurpose::kSpread) {}

void PathTracer::add_indirect(const SurfacePoint& x, float u0, float u1, const PathKey& key, float* weight,
                              float* sum, float* caustic) const {
  const RayTracer& rays = room_->rays();
  const SurfaceModel& surfaces = room_->surfaces();
  const std::size_t bands = surfaces.band_count();
  SurfacePoint point = x;
  Vec3f direction = sample_lambert(x.normal, u0, u1);
  if (!(direction.dot(side_normal(rays, x)) > 0)) return;
  Vec3f origin = ray_origin(rays, x);
  SpecularPath path(*room_, specular_, key);
  for (std::uint32_t bounce = 0;;) {
    Hit hit;
    float* over_mirrors = caustic == nullptr || path.is_scattered() ? sum : caustic;
    if (!rays.closest(origin, direction, hit)) {
      path.leave(direction, weight, over_mirrors);
      return;
    }
    path.arrive(*direct_, hit, direction, weight, over_mirrors);
    SurfaceModel::PointValues at_point;
    const float* reflectance = surfaces.reflectance(hit, at_point);
    const float largest = *std::max_element(reflectance, reflectance + bands);
    const bool specular = surfaces.is_specular(hit.triangle, hit.front);
    if (!(largest > 0) && !specular) return;

    const std::array<float, 4> u = rng_.uniform4(key.index, key.batch, key.step(2 * bounce));
    float survival = 1;
    if (bounce >= kSafeBounces && !specular) {
      survival = std::min(largest, kLongestSurvival);
      if (u[3] >= survival) return;
    }
    point = surface_point(rays, hit, direction);
    const float* here = path.of_light_there(weight);
    if (largest > 0) direct_->add_reflected_sample(point, {u[0], u[1], u[2]}, survival, here, sum);
    if (specular) {
      if (surfaces.spreads(hit.triangle))
        direct_->add_lobe_sample(point, {u[0], u[1], u[2]}, {}, DiffuseWay::kFollowed, here,
                                 {over_mirrors, sum});
      survival = largest;
      const SpecularPath::Next next = path.choose(point, DiffuseWay::kFollowed, survival, weight);
      if (next == SpecularPath::Next::kEnds) return;
      if (next == SpecularPath::Next::kGoesOn) {
        direction = path.direction();
        origin = path.origin();
        continue;
      }
    }
    const std::array<float, 4> u_ray = rng_.uniform4(key.index, key.batch, key.step(2 * bounce + 1));
    const ScatterSample next = surfaces.sample(point, u_ray[0], u_ray[1]);
    direction = next.direction;
    const BrdfValue brdf = surfaces.value(point, direction, at_point);
    for (std::size_t b = 0; b < bands; ++b) {
      weight[b] *= brdf(b) / survival;
      weight[b] *= next.cosine_over_pdf;
    }
    origin = ray_origin(rays, point);
    path.scatter();
    ++bounce;
  }
}

}  // namespace reemit
