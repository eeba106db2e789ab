#pragma once

#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A point on one side of the room at which light is asked for: where a ray met it, or one of a zone or
/// vertex.
struct SurfacePoint {
  TriangleId triangle;
  float u = 0;  ///< Barycentric, as ZoneMesh::point.
  float v = 0;
  bool front = true;
  /// Unit, on the same side as `front`. The geometric normal for transport; what a camera sees may use a
  /// shading normal, and then only directions above both count.
  Vec3f normal{0, 0, 1};
  /// Unit, to where the light is seen from: back along the ray that met the point. 0 where irradiance is
  /// asked for, which no viewer has a part in.
  Vec3f towards{0, 0, 0};
  float footprint = 0;  ///< Of what is seen at once, across; textures are averaged over it [normalised].
};

/// Geometric normal at a point of one side of a triangle or patch.
inline Vec3f side_normal(const RayTracer& rays, TriangleId t, float u, float v, bool front) {
  const Vec3f normal = rays.normal(t, u, v);
  return front ? normal : Vec3f(-normal);
}
inline Vec3f side_normal(const RayTracer& rays, const SurfacePoint& x) {
  return side_normal(rays, x.triangle, x.u, x.v, x.front);
}

/// Start of a ray that leaves the point.
inline Vec3f ray_origin(const RayTracer& rays, const SurfacePoint& x) {
  return rays.ray_origin(x.triangle, x.u, x.v, x.front);
}

/// Point with the geometric normal.
inline SurfacePoint surface_point(const RayTracer& rays, TriangleId t, float u, float v, bool front) {
  return {t, u, v, front, side_normal(rays, t, u, v, front)};
}
/// The same place on the other side, with the geometric normal.
inline SurfacePoint other_side(const RayTracer& rays, const SurfacePoint& x) {
  return surface_point(rays, x.triangle, x.u, x.v, !x.front);
}
/// Where a ray of this direction (unit) met the room.
inline SurfacePoint surface_point(const RayTracer& rays, const Hit& hit, const Vec3f& direction) {
  SurfacePoint point = surface_point(rays, hit.triangle, hit.u, hit.v, hit.front);
  point.towards = -direction;
  return point;
}

}  // namespace reemit
