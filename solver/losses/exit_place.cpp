#include "solver/losses/exit_place.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Tilts in `kTurns` directions about the ray, opposite ones `kTurns / 2` apart.
constexpr std::size_t kTurns = 8;
/// Tangent of the smallest tilt: above that of the second look (RayTracer::second_direction).
constexpr float kLeastTilt = 1e-5F;
constexpr float kMostTilt = 4;
constexpr float kStep = 2;

}  // namespace

ExitPlace find_exit(const RayTracer& rays, const Vec3f& origin, const Vec3f& direction) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Frame frame(direction);
  std::array<double, kTurns> reach;  // from the ray to the rim [normalised units]
  reach.fill(kFar);
  ExitPlace exit;
  double nearest = kFar;
  for (std::size_t turn = 0; turn < kTurns; ++turn) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(turn) / kTurns;
    const Vec3f side = std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent;
    for (float tilt = kLeastTilt; tilt <= kMostTilt; tilt *= kStep) {
      Hit hit;
      const Vec3f tilted = (direction + tilt * side).normalized();
      if (!rays.closest(origin, tilted, hit)) continue;
      const Vec3f point = origin + hit.distance * tilted;
      reach[turn] = static_cast<double>(side.dot(point - origin));
      exit.surfaces.insert(rays.mesh().surface(hit.triangle, hit.front));
      if (reach[turn] < nearest) {
        nearest = reach[turn];
        exit.point = rays.in_room(point);
      }
      exit.found = true;
      break;
    }
  }
  double width = kFar;
  for (std::size_t turn = 0; turn < kTurns / 2; ++turn)
    width = std::min(width, reach[turn] + reach[turn + kTurns / 2]);
  exit.width = width * rays.metres_per_unit();
  return exit;
}

bool is_outside(const RayTracer& rays, const Vec3f& origin, const Vec3f& direction) {
  constexpr std::uint32_t kLooks = 32;
  constexpr int kMostHits = 2;
  const Frame frame(direction);
  const SobolSequence numbers(0);
  int hits = 0;
  for (std::uint32_t k = 0; k < kLooks && hits <= kMostHits; ++k) {
    const Vec3f local = sample_cosine_hemisphere(numbers.sample(k, 0), numbers.sample(k, 1));
    if (!rays.escapes(origin, frame.to_world(local))) ++hits;
  }
  return hits <= kMostHits;
}

}  // namespace reemit
