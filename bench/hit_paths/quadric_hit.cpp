#include "bench/hit_paths/quadric_hit.h"

#include <array>
#include <cmath>

namespace reemit::hit_paths {
namespace {

/// Real roots of a t^2 + 2 b t + c in rising order, without cancellation; none: two NaN.
std::array<double, 2> roots(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || (a == 0 && b == 0)) return {NAN, NAN};
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (a == 0) return {c / q, NAN};
  const double t0 = q / a;
  const double t1 = q != 0 ? c / q : 0;
  return t0 < t1 ? std::array<double, 2>{t0, t1} : std::array<double, 2>{t1, t0};
}

struct Nearest {
  const Vec3& origin;
  const Vec3& direction;
  double near, far;
  Vec3& normal;

  bool in_range(double t) const { return t > near && t < far; }

  std::optional<double> operator()(const Sphere& s) const {
    const Vec3 o = origin - s.centre;
    for (const double t : roots(1, o.dot(direction), o.squaredNorm() - s.radius * s.radius)) {
      if (!in_range(t)) continue;
      normal = (o + t * direction).normalized() * (s.inward ? -1 : 1);
      return t;
    }
    return std::nullopt;
  }

  std::optional<double> operator()(const Disk& d) const {
    const double t = d.normal.dot(d.centre - origin) / d.normal.dot(direction);
    if (!in_range(t)) return std::nullopt;
    const double r = (origin + t * direction - d.centre).norm();
    if (r > d.radius || r < d.inner_radius) return std::nullopt;
    normal = d.normal;
    return t;
  }

  std::optional<double> operator()(const Cylinder& c) const {
    return mantle(c.base, c.top, c.radius, c.radius, c.inward);
  }
  std::optional<double> operator()(const Cone& c) const {
    return mantle(c.base, c.top, c.base_radius, c.top_radius, c.inward);
  }

  /// |x across the axis| = r0 + slope * (x along the axis).
  std::optional<double> mantle(const Vec3& base, const Vec3& top, double r0, double r1, bool inward) const {
    const double height = (top - base).norm();
    const Vec3 axis = (top - base) / height;
    const double slope = (r1 - r0) / height;
    const Vec3 o = origin - base;
    const double oz = o.dot(axis);
    const double dz = direction.dot(axis);
    const Vec3 across = o - oz * axis;
    const Vec3 turn = direction - dz * axis;
    const double radius = r0 + slope * oz;
    for (const double t :
         roots(turn.squaredNorm() - slope * slope * dz * dz, across.dot(turn) - slope * dz * radius,
               across.squaredNorm() - radius * radius)) {
      const double z = oz + t * dz;
      if (!in_range(t) || !(z >= 0 && z <= height) || r0 + slope * z < 0) continue;
      const Vec3 outward = (across + t * turn).normalized() - slope * axis;
      normal = outward.normalized() * (inward ? -1 : 1);
      return t;
    }
    return std::nullopt;
  }
};

}  // namespace

std::optional<double> nearest_on_shape(const CurvedShape& shape, const Vec3& origin, const Vec3& direction,
                                       double near, double far, Vec3& normal) {
  return std::visit(Nearest{origin, direction, near, far, normal}, shape);
}

}  // namespace reemit::hit_paths
