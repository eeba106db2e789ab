#pragma once
#include <cstdint>

#include "mesh/zones/zone_mesh.h"
#include "solver/matrix/convex_polygon.h"
#include "solver/sampling/counter_rng.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// What the random numbers of the matrix method are for.
enum class MatrixNumbers : std::uint32_t { kFirstRays, kShare, kLeaks, kLightOnZone, kLightLeaks, kNoise };

/// 64 random bits for scramble `part` of item `index` (a zone, or a pair as i * zones + j).
inline std::uint64_t matrix_seed(std::uint64_t seed, MatrixNumbers what, std::uint64_t index,
                                 std::uint32_t part) {
  const auto bits =
      CounterRng(seed, RngPurpose::kFormFactor).bits4(index, static_cast<std::uint32_t>(what), part);
  return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
}

/// Points of a zone as starts of rays.
class ZonePoints {
 public:
  ZonePoints(const ZoneMesh& mesh, const RayTracer& rays, ZoneId zone) {
    const TriangleId t = mesh.zone_triangle(zone);
    const bool front = mesh.zone_is_front(zone);
    const auto corners = mesh.zone_barycentrics(zone);
    for (std::size_t k = 0; k < 3; ++k)
      corner_[k] = rays.point(t, static_cast<float>(corners[k].u), static_cast<float>(corners[k].v));
    normal_ = front ? rays.normal(t) : Vec3f(-rays.normal(t));
    middle_ = (rays.corner(t, 0) + rays.corner(t, 1) + rays.corner(t, 2)) / 3.0F;
  }

  const Vec3f& normal() const { return normal_; }
  /// Start of a ray at barycentric point (u,v) of the zone [normalised units].
  Vec3f origin(float u, float v) const {
    return RayTracer::lifted((1 - u - v) * corner_[0] + u * corner_[1] + v * corner_[2], normal_, middle_);
  }

 private:
  Vec3f corner_[3];
  Vec3f normal_, middle_;
};

/// The zone as a polygon that runs counter-clockwise seen from its own side.
inline ConvexPolygon zone_polygon(const ZoneMesh& mesh, ZoneId zone) {
  ConvexPolygon polygon;
  polygon.normal = mesh.zone_normal(zone);
  const TriangleId t = mesh.zone_triangle(zone);
  const auto corners = mesh.zone_barycentrics(zone);
  const bool front = mesh.zone_is_front(zone);
  for (std::size_t k = 0; k < 3; ++k) {
    const Barycentric& c = corners[front ? k : 2 - k];
    polygon.add(mesh.point(t, c.u, c.v));
  }
  return polygon;
}

}  // namespace reemit
