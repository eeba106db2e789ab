#include "solver/losses/probe_flight.h"

#include <fmt/format.h>

namespace reemit {

void look_again(const RayScene& scene, const Ray16& rays, int count, Hit16& hits) {
  Ray16 turned;
  for (int lane = 0; lane < count; ++lane)
    turned.set(lane, rays.origin(lane), RayScene::nudged(rays.direction(lane)));
  Hit16 second;
  scene.closest16(turned, count, second);
  for (int lane = 0; lane < count; ++lane) {
    if (hits.triangle[lane] != RayScene::kMiss) continue;
    hits.triangle[lane] = second.triangle[lane];
    hits.u[lane] = second.u[lane];
    hits.v[lane] = second.v[lane];
    hits.distance[lane] = second.distance[lane];
    hits.front[lane] = second.front[lane];
  }
}

std::string quoted_name(const Scene& scene, SurfaceId surface) {
  const std::string& name = scene.surfaces[surface.index()].name;
  return name.empty() ? fmt::format("surface {}", surface.index()) : "'" + name + "'";
}

std::string share_text(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

std::string place_text(const Vec3& point) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", point.x(), point.y(), point.z());
}

}  // namespace reemit
