#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/model/vec.h"

namespace reemit {

// Mappings from uniform numbers in [0,1) to the shapes that light transport samples. Each stands beside its
// density; the measure is in the name. Pure functions of their arguments.

struct Point2 {
  float x, y;
};

inline constexpr float kLargestBelowOne = 0x1.fffffep-1F;

/// A number of [0,1) that fell into the interval [low, low + width), stretched over it so that it can be used
/// again ([SWZ96] Fig. 8).
inline float stretched(float u, float low, float width) {
  return std::clamp((u - low) / width, 0.0F, kLargestBelowOne);
}

/// Uniform on the unit disk, concentric map: keeps strata compact [SC97].
inline Point2 sample_disk(float u0, float u1) {
  const float a = 2 * u0 - 1;
  const float b = 2 * u1 - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr float kQuarter = std::numbers::pi_v<float> / 4;
  const bool wide = std::fabs(a) > std::fabs(b);
  const float r = wide ? a : b;
  const float phi = wide ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Inverse of sample_disk.
inline std::array<float, 2> invert_disk(Point2 p) {
  constexpr float kQuarter = std::numbers::pi_v<float> / 4;
  const float r = std::sqrt(p.x * p.x + p.y * p.y);
  float phi = std::atan2(p.y, p.x);
  if (phi < -kQuarter) phi += 2 * std::numbers::pi_v<float>;
  float a = 0;
  float b = 0;
  if (phi < kQuarter) {
    a = r;
    b = phi * a / kQuarter;
  } else if (phi < 3 * kQuarter) {
    b = r;
    a = -(phi - 2 * kQuarter) * b / kQuarter;
  } else if (phi < 5 * kQuarter) {
    a = -r;
    b = (phi - 4 * kQuarter) * a / kQuarter;
  } else {
    b = -r;
    a = -(phi - 6 * kQuarter) * b / kQuarter;
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

/// Direction about +z with density cos(theta)/pi per steradian (Malley's method).
inline Vec3f sample_cosine_hemisphere(float u0, float u1) {
  const Point2 d = sample_disk(u0, u1);
  return {d.x, d.y, std::sqrt(std::max(0.0F, 1 - d.x * d.x - d.y * d.y))};
}
/// [1/sr]; 0 below the horizon.
inline float cosine_hemisphere_pdf_per_sr(float cos_theta) {
  return std::max(0.0F, cos_theta) * std::numbers::inv_pi_v<float>;
}

/// Direction about +z with density (k+1)/(2 pi) cos(theta)^k per steradian, k >= 0.
inline Vec3f sample_cosine_power(float u0, float u1, float k) {
  const Point2 d = sample_disk(u0, u1);
  const float r2 = std::min(1.0F, d.x * d.x + d.y * d.y);
  const float z = std::pow(1 - r2, 1 / (k + 1));
  const float stretch = r2 > 0 ? std::sqrt(std::max(0.0F, 1 - z * z) / r2) : 0.0F;
  return {stretch * d.x, stretch * d.y, z};
}

/// Barycentric (u,v) of a uniform point in a triangle [TUR90]; density 1/area per area.
inline std::array<float, 2> sample_triangle(float u0, float u1) {
  const float s = std::sqrt(u0);
  return {s * (1 - u1), s * u1};
}

/// Uniform on the unit sphere; density 1/(4 pi) per steradian.
inline Vec3f sample_sphere(float u0, float u1) {
  const float z = 1 - 2 * u0;
  const float r = std::sqrt(std::max(0.0F, 1 - z * z));
  const float phi = 2 * std::numbers::pi_v<float> * u1;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Orthonormal frame about a unit normal without a branch on its direction [DUF17].
struct Frame {
  Vec3f tangent, bitangent, normal;
  explicit Frame(const Vec3f& n) : normal(n) {
    const float sign = std::copysign(1.0F, n.z());
    const float a = -1 / (sign + n.z());
    const float b = n.x() * n.y() * a;
    tangent = {1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()};
    bitangent = {b, sign + n.y() * n.y() * a, -n.y()};
  }
  Vec3f to_world(const Vec3f& local) const {
    return local.x() * tangent + local.y() * bitangent + local.z() * normal;
  }
  Vec3f to_local(const Vec3f& world) const {
    return {world.dot(tangent), world.dot(bitangent), world.dot(normal)};
  }
};

}  // namespace reemit
