#pragma once
#include <cstdint>

#include "solver/sampling/counter_rng.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// A point on one side of the room at which light is asked for.
struct SurfacePoint {
  TriangleId triangle;
  float u = 0;  ///< Barycentric, as ZoneMesh::point.
  float v = 0;
  bool front = true;
  /// Unit, on the same side as `front`. The geometric normal for transport; what a camera sees may use a
  /// shading normal, and then only directions above both count.
  Vec3f normal{0, 0, 1};
};

/// Geometric normal at a point of one side of a triangle or patch.
inline Vec3f side_normal(const RayScene& rays, TriangleId t, float u, float v, bool front) {
  const Vec3f normal = rays.normal(t, u, v);
  return front ? normal : Vec3f(-normal);
}
inline Vec3f side_normal(const RayScene& rays, const SurfacePoint& x) {
  return side_normal(rays, x.triangle, x.u, x.v, x.front);
}

/// Point with the geometric normal.
inline SurfacePoint surface_point(const RayScene& rays, TriangleId t, float u, float v, bool front) {
  return {t, u, v, front, side_normal(rays, t, u, v, front)};
}
inline SurfacePoint surface_point(const RayScene& rays, const Hit& hit) {
  return surface_point(rays, hit.triangle, hit.u, hit.v, hit.front);
}

/// Names the random numbers of one path; each bounce takes its own steps of the generator.
struct PathKey {
  std::uint64_t index = 0;  ///< Pixel, vertex or zone.
  std::uint32_t batch = 0;  ///< Pass or replicate.
  std::uint32_t path = 0;   ///< Number of the path within the batch, < 2^20.
  std::uint32_t part = 0;   ///< Part of the zone solution that is read, < RadianceField::parts().

  static constexpr std::uint32_t kStepsPerPath = 4096;
  std::uint32_t step(std::uint32_t number) const { return path * kStepsPerPath + number; }
};

}  // namespace reemit
