#include "solver/gather/path_tracer.h"

#include <algorithm>
#include <numbers>

#include "solver/reflect/lambert.h"

namespace reemit {

PathTracer::PathTracer(const RayScene& rays, const RadianceField& materials, const DirectLight& direct,
                       std::uint64_t seed)
    : rays_(&rays), materials_(&materials), direct_(&direct), rng_(seed, RngPurpose::kPath) {}

void PathTracer::add_indirect(const SurfacePoint& x, float u0, float u1, const PathKey& key, float* weight,
                              float* sum) const {
  const std::size_t bands = materials_->band_count();
  SurfacePoint point = x;
  Vec3f direction = sample_lambert(x.normal, u0, u1);
  if (!(direction.dot(side_normal(*rays_, x)) > 0)) return;
  for (std::uint32_t bounce = 0;; ++bounce) {
    Hit hit;
    if (!rays_->closest(rays_->ray_origin(point.triangle, point.u, point.v, point.front), direction, hit))
      return;
    const float* reflectance = materials_->reflectance(hit.triangle.index(), hit.front);
    const float largest = *std::max_element(reflectance, reflectance + bands);
    if (!(largest > 0)) return;

    const std::array<float, 4> u = rng_.uniform4(key.index, key.batch, key.step(2 * bounce));
    const std::array<float, 4> u_ray = rng_.uniform4(key.index, key.batch, key.step(2 * bounce + 1));
    float survival = 1;
    if (bounce >= kSafeBounces) {
      survival = std::min(largest, kLongestSurvival);
      if (u[3] >= survival) return;
    }
    point = surface_point(*rays_, hit);
    for (std::size_t b = 0; b < bands; ++b) weight[b] *= lambert_brdf_per_sr(reflectance[b]) / survival;
    direct_->add_sample(point, {u[0], u[1], u[2]}, weight, sum);
    for (std::size_t b = 0; b < bands; ++b) weight[b] *= std::numbers::pi_v<float>;
    direction = sample_lambert(point.normal, u_ray[0], u_ray[1]);
  }
}

}  // namespace reemit
