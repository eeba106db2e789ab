#include "bench/hit_paths/path_step.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "bench/hit_paths/smooth_surface.h"

namespace reemit::hit_paths {
namespace {

/// Largest chance of going on.
constexpr double kLongestSurvival = 0.98;

Vec3 cosine_direction(const Vec3& normal, PathRandom& random) {
  const double r = std::sqrt(uniform(random));
  const double phi = 2 * std::numbers::pi * uniform(random);
  const Vec3 tangent = normal.unitOrthogonal();
  return (r * std::cos(phi) * tangent + r * std::sin(phi) * normal.cross(tangent) +
          std::sqrt(std::max(0.0, 1 - r * r)) * normal)
      .normalized();
}

}  // namespace

double uniform(PathRandom& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

std::optional<PathStep> next_step(const RoomHit& hit, const Vec3& direction, bool roulette,
                                  PathRandom& random) {
  const SmoothShares smooth = smooth_shares(*hit.material, arrival_angle(hit, direction), hit.front);
  const double spread = hit.material->reflectance.maxCoeff();
  const double mirror = smooth.mirrored.maxCoeff();
  const double sum = spread + mirror + smooth.crossing.maxCoeff();
  if (!(sum > 0)) return std::nullopt;
  PathStep step;
  double survival = 1;
  if (roulette) {
    survival = std::min(sum, kLongestSurvival);
    if (uniform(random) >= survival) return std::nullopt;
  }
  // Rooms without mirrors and glass use no number here.
  const double choice = sum > spread ? sum * uniform(random) : 0;
  const auto weigh = [&](const Spectrum& share) {
    step.weight = share * (sum / share.maxCoeff() / survival);
  };
  if (choice < spread) {
    weigh(hit.material->reflectance);
    step.direction = cosine_direction(hit.normal, random);
    step.scatters = true;
  } else if (choice < spread + mirror) {
    weigh(smooth.mirrored);
    step.direction = mirrored(hit, direction);
  } else {
    weigh(smooth.crossing);
    step.direction = crossing(hit, direction);
    step.crosses = true;
  }
  return step;
}

}  // namespace reemit::hit_paths
