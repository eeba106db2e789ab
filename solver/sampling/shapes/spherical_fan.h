#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "scenes/model/vec.h"
#include "solver/sampling/shapes/clipped_polygon.h"

namespace reemit {

/// Uniform directions in the convex spherical polygon of a clipped polygon, as a fan of spherical triangles
/// about its first corner. The idea of [ARV95], sub-triangles by solid angle; solid angle of a triangle from
/// [VOS83] eq. 8, whose inverse is taken in closed form in half angles, as [PET21] does, so that triangles of
/// 1e-7 sr keep 9 digits.
class SphericalFan {
 public:
  explicit SphericalFan(const ClippedPolygon& polygon);

  double solid_angle() const { return total_; }                             ///< [sr]; 0 if degenerate.
  std::span<const Vec3> corners() const { return {unit_.data(), count_}; }  ///< Unit.
  Vec3 sample(double u0, double u1) const;                                  ///< Unit.
  std::array<double, 2> invert(const Vec3& direction) const;

 private:
  std::array<Vec3, kMostCorners + 1> unit_;              // corners as directions
  std::array<double, kMostCorners + 1> solid_angle_to_;  // of triangles before corner i
  std::size_t count_ = 0;
  double total_ = 0;
};

}  // namespace reemit
