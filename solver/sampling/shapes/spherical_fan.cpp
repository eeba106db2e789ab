#include "solver/sampling/shapes/spherical_fan.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

/// Solid angle of the spherical triangle of unit vectors [VOS83] eq. 8. The determinant is taken of
/// differences, so that narrow triangles keep their digits.
double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double volume = std::fabs(a.dot((b - a).cross(c - a)));
  return 2 * std::atan2(volume, 1 + a.dot(b) + b.dot(c) + c.dot(a));
}

}  // namespace

SphericalFan::SphericalFan(const ClippedPolygon& polygon) : count_(polygon.count) {
  if (count_ < 3) {
    count_ = 0;
    return;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const double length = polygon.corner[i].norm();
    if (!(length > 0)) {  // x is a corner
      count_ = 0;
      return;
    }
    unit_[i] = polygon.corner[i] / length;
  }
  solid_angle_to_[0] = 0;
  solid_angle_to_[1] = 0;
  for (std::size_t i = 1; i + 1 < count_; ++i) {
    total_ += triangle_solid_angle(unit_[0], unit_[i], unit_[i + 1]);
    solid_angle_to_[i + 1] = total_;
  }
}

Vec3 SphericalFan::sample(double u0, double u1) const {
  const double target = u0 * total_;
  std::size_t i = 1;
  while (i + 2 < count_ && target >= solid_angle_to_[i + 1]) ++i;
  const Vec3& b = unit_[0];
  const Vec3& a = unit_[i];
  const Vec3& c = unit_[i + 1];

  // Point c' of the arc a-c such that (a, b, c') has the solid angle wanted: with t the tangent of the arc at
  // a, c' = a cos s + t sin s, [VOS83] eq. 8 is linear in tan(s/2).
  const double half_angle = 0.5 * std::max(0.0, target - solid_angle_to_[i]);
  const double wanted_s = std::sin(half_angle);
  const double wanted_c = std::cos(half_angle);
  Vec3 t = c - a;
  t -= a.dot(t) * a;
  const double tangent_length = t.norm();
  if (tangent_length > 0) t /= tangent_length;
  const double volume = std::fabs(t.dot((b - a).cross(a)));
  const double across = wanted_c * volume - wanted_s * b.dot(t);
  const double full = std::atan2(tangent_length, a.dot(c));
  const double s = std::clamp(2 * std::atan2(wanted_s * (1 + a.dot(b)), across), 0.0, full);
  const Vec3 on_arc = std::cos(s) * a + std::sin(s) * t;

  // Uniform in 1 - cos along the arc b-c'.
  Vec3 away = on_arc - b;
  const double below = u1 * 0.5 * away.squaredNorm();  // 1 - cos
  away -= b.dot(away) * b;
  const double length = away.norm();
  const double sine = std::sqrt(below * std::max(0.0, 2 - below));
  return (1 - below) * b + (length > 0 ? sine / length : 0.0) * away;
}

std::array<double, 2> SphericalFan::invert(const Vec3& direction) const {
  if (count_ < 3) return {0.5, 0.5};
  const Vec3& b = unit_[0];
  const Vec3 across = b.cross(direction - b);
  // Triangles are passed in one sense of rotation about b.
  const double sense = b.dot((unit_[1] - b).cross(unit_[count_ - 1] - b));
  std::size_t i = 1;
  while (i + 2 < count_ && across.dot(unit_[i + 1] - b) * sense < 0) ++i;
  const Vec3& a = unit_[i];
  const Vec3& c = unit_[i + 1];
  const Vec3 arc_normal = a.cross(c - a);
  Vec3 on_arc = across.cross(arc_normal);
  if (on_arc.dot(a + c) < 0) on_arc = -on_arc;
  const double length = on_arc.norm();
  if (!(length > 0) || !(total_ > 0)) return {0.5, 0.5};
  on_arc /= length;
  const double full = (on_arc - b).squaredNorm();
  return {std::clamp((solid_angle_to_[i] + triangle_solid_angle(a, b, on_arc)) / total_, 0.0, 1.0),
          full > 0 ? std::clamp((direction - b).squaredNorm() / full, 0.0, 1.0) : 0.5};
}

}  // namespace reemit
