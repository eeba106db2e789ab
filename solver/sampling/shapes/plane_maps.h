#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/model/vec.h"

namespace reemit {

// Double precision maps of the unit square that the shapes share; warp.h has the float ones.

/// Uniform on the unit disk, concentric map [SC97].
inline std::array<double, 2> unit_disk(double u0, double u1) {
  const double a = 2 * u0 - 1;
  const double b = 2 * u1 - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kQuarter = std::numbers::pi / 4;
  const bool wide = std::fabs(a) > std::fabs(b);
  const double r = wide ? a : b;
  const double phi = wide ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Inverse of unit_disk.
inline std::array<double, 2> invert_unit_disk(double x, double y) {
  constexpr double kPerQuarter = 4 * std::numbers::inv_pi;
  const double r = std::min(1.0, std::sqrt(x * x + y * y));
  double a = 0;
  double b = 0;
  if (std::fabs(x) > std::fabs(y)) {
    a = std::copysign(r, x);
    b = a * kPerQuarter * std::atan(y / x);
  } else if (r > 0) {
    b = std::copysign(r, y);
    a = b * kPerQuarter * std::atan(x / y);
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

/// Uniform on the cap of the unit sphere about +z; `height` = 1 - cos(half angle), 2 for the whole sphere. As
/// precise for the narrowest cap as for a wide one.
inline Vec3 unit_cap(double u0, double u1, double height) {
  const auto d = unit_disk(u0, u1);
  const double below = height * (d[0] * d[0] + d[1] * d[1]);  // 1 - z
  const double stretch = std::sqrt(height * std::max(0.0, 2 - below));
  return {stretch * d[0], stretch * d[1], 1 - below};
}

/// Inverse of unit_cap.
inline std::array<double, 2> invert_unit_cap(const Vec3& p, double height) {
  const double across = p.x() * p.x() + p.y() * p.y();
  const double below = p.z() > 0 ? across / (1 + p.z()) : 1 - p.z();
  if (!(across > 0)) return {0.5, 0.5};
  const double scale = std::sqrt(below / (height * across));
  return invert_unit_disk(scale * p.x(), scale * p.y());
}

/// Two unit vectors that complete a unit vector to a right-handed frame [DUF17].
struct Tangents {
  Vec3 t, b;
  explicit Tangents(const Vec3& n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());
    const double c = n.x() * n.y() * a;
    t = {1 + sign * n.x() * n.x() * a, sign * c, -sign * n.x()};
    b = {c, sign + n.y() * n.y() * a, -n.y()};
  }
};

/// A frame about a unit `axis` whose first vector points as nearly as possible towards `to`.
struct AlignedFrame {
  Vec3 e1, e2;
  double along;   ///< to . axis
  double across;  ///< |to - along axis|
  AlignedFrame(const Vec3& axis, const Vec3& to) {
    along = axis.dot(to);
    e1 = to - along * axis;
    e1 -= axis.dot(e1) * axis;  // what the first subtraction left
    across = e1.norm();
    if (across > 1e-12 * std::fabs(along) && across > 0) {
      e1 /= across;
    } else {
      e1 = Tangents(axis).t;
      across = 0;
    }
    e2 = axis.cross(e1);
  }
};

}  // namespace reemit
