#include "bench/hit_paths/path_random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace reemit::hit_paths {

double uniform(PathRandom& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3 cosine_direction(const Vec3& normal, PathRandom& random) {
  return direction_about(normal, std::sqrt(1 - uniform(random)), random);
}

Vec3 direction_about(const Vec3& axis, double cosine, PathRandom& random) {
  const double r = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double phi = 2 * std::numbers::pi * uniform(random);
  const Vec3 tangent = axis.unitOrthogonal();
  return (r * std::cos(phi) * tangent + r * std::sin(phi) * axis.cross(tangent) + cosine * axis).normalized();
}

}  // namespace reemit::hit_paths
