#include "solver/gather/path_tracer.h"

#include <algorithm>

#include "solver/reflect/lambert.h"

namespace reemit {

PathTracer::PathTracer(const Room& room, const DirectLight& direct, std::uint64_t seed)
    : room_(&room), direct_(&direct), rng_(seed, RngPurpose::kPath), specular_(seed, RngPurpose::kSpecular) {}

void PathTracer::add_indirect(const SurfacePoint& x, float u0, float u1, const PathKey& key, float* weight,
                              float* sum) const {
  const RayTracer& rays = room_->rays();
  const SurfaceModel& surfaces = room_->surfaces();
  const std::size_t bands = surfaces.band_count();
  SurfacePoint point = x;
  Vec3f direction = sample_lambert(x.normal, u0, u1);
  if (!(direction.dot(side_normal(rays, x)) > 0)) return;
  Vec3f origin = ray_origin(rays, x);
  bool is_bent = false;  // since light was scattered last, so shadow rays did not find what the ray meets
  std::uint32_t crossed = 0;  // mirrors and panes in all
  TriangleId body;            // of glass that the ray was sent into
  SpecularStep step(surfaces.any_specular() ? bands : 0);
  for (std::uint32_t bounce = 0;;) {
    Hit hit;
    if (!rays.closest(origin, direction, hit)) return;
    surfaces.attenuate(surfaces.body_around(hit.triangle, hit.front, body), hit.distance, weight);
    if (is_bent) add_emission(surfaces, surface_point(rays, hit, direction), weight, sum);
    const float* reflectance = surfaces.reflectance(hit.triangle, hit.front);
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
    if (largest > 0) direct_->add_reflected_sample(point, {u[0], u[1], u[2]}, survival, weight, sum);
    if (specular) {
      if (crossed == SpecularNumbers::kMostSteps) return;
      const SpecularSurface& surface = surfaces.specular(hit.triangle);
      const float on = surface.shares(point.normal.dot(point.towards), point.front, step);
      survival = largest + on > 1 ? largest / (largest + on) : largest;
      const float v = specular_.at(key, crossed++);
      if (!(v < survival)) {
        if (!surface.choose(point, v - survival, Survival::kRoulette, step, 1 - survival)) return;
        for (std::size_t b = 0; b < bands; ++b) weight[b] *= step.share()[b] / step.chance;
        is_bent = is_bent || step.bends;
        body = surfaces.body_beyond(hit.triangle, step.front, body);
        direction = step.direction;
        origin = rays.ray_origin(hit.triangle, hit.u, hit.v, step.front);
        continue;
      }
    }
    const std::array<float, 4> u_ray = rng_.uniform4(key.index, key.batch, key.step(2 * bounce + 1));
    const ScatterSample next = surfaces.sample(point, u_ray[0], u_ray[1]);
    direction = next.direction;
    const BrdfValue brdf = surfaces.value(point, direction);
    for (std::size_t b = 0; b < bands; ++b) {
      weight[b] *= brdf(b) / survival;
      weight[b] *= next.cosine_over_pdf;
    }
    origin = ray_origin(rays, point);
    is_bent = false;
    ++bounce;
  }
}

}  // namespace reemit
