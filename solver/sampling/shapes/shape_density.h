#pragma once
#include <algorithm>
#include <cmath>

#include "scenes/model/vec.h"

namespace reemit {

// Samplers of luminaire shapes as seen from a shading point x with unit normal n. A sampler is made once per
// shading point and then drawn from any number of times; it holds no reference to what it was made from and
// allocates nothing. All of them have the same members:
//
//   bool lights() const;                     false only if nothing of the emitting side can light x
//   ShapePoint sample(double u0, double u1)  u0, u1 in [0,1)
//   double pdf_per_sr(const Vec3& p)         density of the direction to a point p of the shape [1/sr]
//   std::array<double, 2> invert(const Vec3& p)   (u0, u1) of a point that sample() returns
//   Density density() const;                 what is really drawn from, see below
//
// Lengths are in metres, but only ratios matter. The farther a shape, the fewer digits are left in the
// differences that solid angles are made of: beyond kFarSizes sizes polygons and disks are drawn from
// uniformly in (visible) area, where the relative standard deviation of a sample is below 1/kFarSizes unless
// the horizon of x cuts them; cylinders beyond kFarCylinder. Spheres keep their digits at any distance.

/// What a point on a luminaire is uniform in.
enum class Density {
  kArea,         ///< Area of the whole shape.
  kVisibleArea,  ///< Area of the part that can light x: sphere and cylinder the side turned towards it,
                 ///< polygons the part above the horizon; disks as kArea.
  kSolidAngle,   ///< Solid angle as seen from x.
  kCosine,       ///< cos(theta) d omega, theta from n: no variance where nothing is in the way.
};

inline constexpr double kFarSizes = 2000;
inline constexpr double kFarCylinder = 1e5;

struct ShapePoint {
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 0, 1};   ///< Unit, of the emitting side.
  double pdf_per_sr = 0;  ///< Density of the direction from x [1/sr]; 0 if x is behind the emitting side.
  /// cos(theta) / pdf_per_sr [sr]: irradiance per Lambertian radiance that this sample estimates. 0 where the
  /// point cannot light x: below the horizon, or its emitting side turned away.
  double irradiance = 0;
  double cos_emit = 0;  ///< Cosine at the luminaire, >= 0.
};

/// A point drawn uniformly from `area` [m2].
inline ShapePoint area_point(const Vec3& point, const Vec3& normal, double area, const Vec3& x,
                             const Vec3& n) {
  constexpr double kTouching = 1e-200;  // [m2]; keeps weights finite
  ShapePoint s;
  s.point = point;
  s.normal = normal;
  const Vec3 to = point - x;
  const double r2 = to.squaredNorm();
  if (!(r2 > kTouching)) return s;
  const double to_unit = 1 / std::sqrt(r2);
  s.cos_emit = std::max(0.0, -normal.dot(to) * to_unit);
  if (!(s.cos_emit > 0)) return s;
  s.pdf_per_sr = r2 / (s.cos_emit * area);
  s.irradiance = std::max(0.0, n.dot(to) * to_unit) * s.cos_emit * area / r2;
  return s;
}

/// Density per solid angle [1/sr] of a point drawn uniformly from `area`; 0 behind the emitting side.
inline double area_pdf_per_sr(const Vec3& point, const Vec3& normal, double area, const Vec3& x) {
  const Vec3 to = point - x;
  const double r2 = to.squaredNorm();
  const double cos_r = -normal.dot(to);
  return cos_r > 0 ? r2 * std::sqrt(r2) / (cos_r * area) : 0.0;
}

/// A point drawn by its direction (unit) from x with a density per solid angle and the estimate it gives.
inline ShapePoint direction_point(const Vec3& point, const Vec3& normal, const Vec3& direction,
                                  double pdf_per_sr, double irradiance) {
  ShapePoint s;
  s.point = point;
  s.normal = normal;
  s.cos_emit = std::max(0.0, -normal.dot(direction));
  s.pdf_per_sr = pdf_per_sr;
  s.irradiance = irradiance;
  return s;
}

}  // namespace reemit
