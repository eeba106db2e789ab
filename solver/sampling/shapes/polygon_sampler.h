#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "solver/sampling/shapes/clipped_polygon.h"
#include "solver/sampling/shapes/projected_polygon.h"
#include "solver/sampling/shapes/shape_density.h"
#include "solver/sampling/shapes/spherical_fan.h"

namespace reemit {

/// Convex planar polygon, front side emitting. kArea is p8 of [SWZ96] on a fan of triangles, kVisibleArea the
/// same on the part above the horizon; kSolidAngle draws from the spherical polygon above the horizon
/// ([ARV95]), kCosine from its projection ([PET21], no variance).
class ConvexPolygonSampler {
 public:
  /// `corners`: 3 to kMostCorners, in either sense of rotation; `front`: unit normal of the emitting side.
  /// Fewer corners, or corners on a line, light nothing.
  ConvexPolygonSampler(std::span<const Vec3> corners, const Vec3& front, const Vec3& x, const Vec3& n,
                       Density density);

  bool lights() const { return lights_; }
  Density density() const { return density_; }
  ShapePoint sample(double u0, double u1) const;
  double pdf_per_sr(const Vec3& point) const;
  std::array<double, 2> invert(const Vec3& point) const;
  double irradiance() const;  ///< Lambert's formula [sr].

 private:
  void set_up_area(std::span<const Vec3> corners);
  Vec3 on_plane(const Vec3& direction) const;

  Vec3 x_, n_, front_;
  double height_ = 0;  // of x above the plane
  bool lights_ = false;
  Density density_;
  std::size_t count_ = 0;
  double extent_ = 0;                             // area [m2], [sr], projected [sr]
  std::array<Vec3, kMostCorners + 1> corner_;     // set for the densities per area
  std::array<double, kMostCorners + 1> area_to_;  // of fan triangles before corner i
  std::optional<SphericalFan> fan_;
  std::optional<ProjectedPolygon> projection_;
};

/// Triangle: p8 (kArea), [ARV95] (kSolidAngle), [PET21] (kCosine; p9 of [SWZ96] in closed form).
class TriangleSampler : public ConvexPolygonSampler {
 public:
  TriangleSampler(const std::array<Vec3, 3>& corners, const Vec3& front, const Vec3& x, const Vec3& n,
                  Density density)
      : ConvexPolygonSampler(corners, front, x, n, density) {}
};

}  // namespace reemit
