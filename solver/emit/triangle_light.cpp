#include "solver/emit/triangle_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// A luminaire is large as seen from x when its middle is nearer than this many of its longest edges. At the
/// limit, r^2 varies by less than a factor of two over the triangle.
constexpr float kNearEdges = 2;
/// Solid angle [sr] below which the spherical triangle is flat to rounding and area sampling is as good.
constexpr double kSmallestSolidAngle = 1e-5;

Vec3f middle(const TriangleLight& light) {
  return (light.a + light.b + light.c) / 3.0F;
}

bool is_near(const TriangleLight& light, const Vec3f& x) {
  return (middle(light) - x).squaredNorm() < kNearEdges * kNearEdges * light.longest_edge2;
}

/// Angle between two vectors divided by the length of their cross product; finite for parallel ones.
double angle_over_cross(double dot, double cross_length) {
  if (cross_length < 1e-12 * std::fabs(dot)) return dot > 0 ? 1 / dot : 0;
  return std::atan2(cross_length, dot) / cross_length;
}

/// Lambert's polygon formula for the part of the triangle above the horizon; corners are relative to x.
double polygon_irradiance(const std::array<Vec3, 3>& corners, const Vec3& n) {
  std::array<Vec3, 4> polygon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& p = corners[i];
    const Vec3& q = corners[(i + 1) % 3];
    const double hp = n.dot(p);
    const double hq = n.dot(q);
    if (hp >= 0) polygon[count++] = p;
    if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) polygon[count++] = p + (hp / (hp - hq)) * (q - p);
  }
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % count];
    const Vec3 cross = p.cross(q);
    sum += n.dot(cross) * angle_over_cross(p.dot(q), cross.norm());
  }
  return 0.5 * std::fabs(sum);
}

/// Uniform direction inside the spherical triangle of unit vectors a, b, c; false if it is too thin to be
/// sampled so [ARV95].
bool sample_spherical_triangle(const Vec3& a, const Vec3& b, const Vec3& c, double u0, double u1,
                               Vec3& direction, double& solid_angle) {
  const Vec3 ab = a.cross(b);
  const Vec3 bc = b.cross(c);
  const Vec3 ca = c.cross(a);
  // [VOS83] eq. 8: stays exact where the sum of the angles minus pi would cancel.
  const double cos_c = a.dot(b);
  solid_angle = 2 * std::atan2(std::fabs(a.dot(bc)), 1 + cos_c + b.dot(c) + c.dot(a));
  if (!(solid_angle > kSmallestSolidAngle)) return false;
  const double thin = std::min({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
  if (!(thin > 1e-16)) return false;
  const double cos_alpha = std::clamp(-ab.normalized().dot(ca.normalized()), -1.0, 1.0);
  const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha);
  if (!(sin_alpha > 1e-8)) return false;

  const double angle = u0 * solid_angle - std::acos(cos_alpha);
  const double s = std::sin(angle);
  const double t = std::cos(angle);
  const double u = t - cos_alpha;
  const double v = s + sin_alpha * cos_c;
  const double denominator = (v * s + u * t) * sin_alpha;
  const double q =
      denominator != 0 ? std::clamp(((v * t - u * s) * cos_alpha - v) / denominator, -1.0, 1.0) : 1.0;
  const Vec3 c_new = q * a + std::sqrt(std::max(0.0, 1 - q * q)) * (c - c.dot(a) * a).normalized();
  const double z = 1 - u1 * (1 - c_new.dot(b));
  const Vec3 across = c_new - c_new.dot(b) * b;
  const double length = across.norm();
  direction = z * b;
  if (length > 0) direction += std::sqrt(std::max(0.0, 1 - z * z)) / length * across;
  return true;
}

}  // namespace

float unoccluded_irradiance(const TriangleLight& light, const Vec3f& x, const Vec3f& n) {
  const float in_front = light.normal.dot(x - light.a);
  if (!(in_front > 0)) return 0;
  const Vec3f a = light.a - x;
  const Vec3f b = light.b - x;
  const Vec3f c = light.c - x;
  const float height =
      (std::max(0.0F, n.dot(a)) + std::max(0.0F, n.dot(b)) + std::max(0.0F, n.dot(c))) / 3.0F;
  if (!(height > 0)) return 0;
  const float distance2 = (middle(light) - x).squaredNorm();
  const float far_field = light.area * height * in_front / std::max(distance2 * distance2, 1e-30F);
  if (!is_near(light, x)) return far_field;
  const auto exact = static_cast<float>(
      polygon_irradiance({a.cast<double>(), b.cast<double>(), c.cast<double>()}, n.cast<double>()));
  // A part just above the horizon must keep a weight even when the formula rounds to 0.
  return std::isfinite(exact) && exact > 0 ? exact : std::min(far_field, 1e-6F);
}

bool sample_triangle_light(const TriangleLight& light, const Vec3f& x, const Vec3f& n, float u0, float u1,
                           TriangleLightSample& sample) {
  const float in_front = light.normal.dot(x - light.a);
  if (!(in_front > 0)) return false;
  if (is_near(light, x)) {
    const Vec3 a = (light.a - x).cast<double>();
    const Vec3 b = (light.b - x).cast<double>();
    const Vec3 c = (light.c - x).cast<double>();
    Vec3 d;
    double solid_angle = 0;
    if (sample_spherical_triangle(a.normalized(), b.normalized(), c.normalized(), u0, u1, d, solid_angle)) {
      const double cos_x = d.dot(n.cast<double>());
      if (!(cos_x > 0)) return false;
      // Barycentric position where the direction meets the plane (Cramer's rule).
      const Vec3 e1 = b - a;
      const Vec3 e2 = c - a;
      const Vec3 p = d.cross(e2);
      const double determinant = e1.dot(p);
      if (determinant == 0) return false;
      const double u = std::clamp(-a.dot(p) / determinant, 0.0, 1.0);
      const double v = std::clamp(-d.dot(a.cross(e1)) / determinant, 0.0, 1.0 - u);
      sample.u = static_cast<float>(u);
      sample.v = static_cast<float>(v);
      sample.factor = static_cast<float>(cos_x * solid_angle);
      return true;
    }
  }
  const auto [u, v] = sample_triangle(u0, u1);
  const Vec3f to_light = (1 - u - v) * light.a + u * light.b + v * light.c - x;
  const float height = n.dot(to_light);
  const float distance2 = to_light.squaredNorm();
  if (!(height > 0) || !(distance2 > 0)) return false;
  sample.u = u;
  sample.v = v;
  sample.factor = light.area * height * in_front / (distance2 * distance2);
  return true;
}

}  // namespace reemit
