#pragma once
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit::test {

// Irradiance of Lambertian luminaires by Lambert's contour integral, in double precision and without any
// sampling: half the sum over the edges of the contour that is seen of angle x (unit normal of the plane of
// edge and point) . n. It depends on nothing of the program.

using Contour = std::vector<Vec3>;  ///< Closed; [m].

/// Corners for a circle: an inscribed polygon of n sides lacks (2 pi / n)^2 / 6 of its area, 1.5e-9.
inline constexpr int kContourSides = 1 << 16;

/// Part of an arc: centre + radius (cos t u + sin t v) for t from `from` to `to`, both ends included.
inline void add_arc(Contour& contour, const Vec3& centre, const Vec3& u, const Vec3& v, double radius,
                    double from, double to, int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double t = from + (to - from) * i / steps;
    contour.push_back(centre + radius * (std::cos(t) * u + std::sin(t) * v));
  }
}

inline Contour circle(const Vec3& centre, const Vec3& axis, double radius) {
  const Vec3 u = axis.unitOrthogonal();
  Contour contour;
  add_arc(contour, centre, u, axis.normalized().cross(u), radius, 0, 2 * std::numbers::pi, kContourSides);
  contour.pop_back();
  return contour;
}

/// The circle at which rays from x touch a sphere. Pre: x outside.
inline Contour outline_of_sphere(const Vec3& centre, double radius, const Vec3& x) {
  const Vec3 towards = x - centre;
  const double share = radius * radius / towards.squaredNorm();
  return circle(centre + share * towards, towards, radius * std::sqrt(1 - share));
}

/// Border of what is seen from x of the outside of a mantle without ends. Pre: x outside of the endless
/// cylinder.
inline Contour outline_of_cylinder(const Vec3& base, const Vec3& top, double radius, const Vec3& x) {
  const Vec3 axis = (top - base).normalized();
  const Vec3 from_axis = x - base - axis.dot(x - base) * axis;
  const Vec3 u = from_axis.normalized();
  const double half = std::acos(radius / from_axis.norm());
  Contour contour;
  add_arc(contour, base, u, axis.cross(u), radius, -half, half, kContourSides);
  add_arc(contour, top, u, axis.cross(u), radius, half, -half, kContourSides);
  return contour;
}

/// The part of a contour above the plane through x with normal n.
inline Contour above_horizon(const Contour& contour, const Vec3& x, const Vec3& n) {
  Contour kept;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Vec3& a = contour[i];
    const Vec3& b = contour[(i + 1) % contour.size()];
    const double ha = n.dot(a - x);
    const double hb = n.dot(b - x);
    if (ha >= 0) kept.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) kept.push_back(a + ha / (ha - hb) * (b - a));
  }
  return kept;
}

/// Irradiance [W/m2] at x with unit normal n from radiance 1 within the contour.
inline double contour_irradiance(const Contour& contour, const Vec3& x, const Vec3& n) {
  const Contour seen = above_horizon(contour, x, n);
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Vec3 a = seen[i] - x;
    const Vec3 edge = seen[(i + 1) % seen.size()] - seen[i];
    const Vec3 across = a.cross(edge);
    const double length = across.norm();
    if (length > 0) sum += std::atan2(length, a.dot(a + edge)) / length * n.dot(across);
  }
  return std::fabs(sum) / 2;
}

}  // namespace reemit::test
