#include "solver/matrix/leaks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "solver/matrix/zone_points.h"
#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {
namespace {

std::uint32_t nearest_axis(const Vec3f& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::uint32_t>(2 * axis + (direction[axis] < 0 ? 1 : 0));
}

/// Account in which a ray ends; nothing if it meets a zone.
std::optional<std::uint32_t> end_of_ray(const RayTracer& rays, const Vec3f& origin, const Vec3f& direction) {
  Hit hit;
  if (!rays.closest(origin, direction, hit)) return nearest_axis(direction);
  const ZoneMesh& mesh = rays.mesh();
  if (mesh.has_zones(hit.triangle, hit.front)) return std::nullopt;
  return LeakAccount::kAxes + static_cast<std::uint32_t>(mesh.triangle(hit.triangle).surface.index());
}

void count(std::vector<LeakAccount>& accounts, std::uint32_t account) {
  const auto found = std::find_if(accounts.begin(), accounts.end(),
                                  [account](const LeakAccount& a) { return a.account == account; });
  if (found == accounts.end())
    accounts.push_back({account, 1});
  else
    ++found->rays;
}

}  // namespace

ZoneLeaks trace_leaks(const RayTracer& rays, std::uint64_t seed) {
  const ZoneMesh& mesh = rays.mesh();
  std::vector<std::vector<LeakAccount>> leaks(mesh.zone_count());
  tbb::parallel_for(std::size_t{0}, mesh.zone_count(), [&](std::size_t z) {
    const ZonePoints points(mesh, rays, ZoneId(z));
    const SobolSequence numbers(matrix_seed(seed, MatrixNumbers::kLeaks, z, 0));
    const Frame frame(points.normal());
    for (std::uint32_t k = 0; k < ZoneLeaks::kRaysPerZone; ++k) {
      const auto [u, v] = sample_triangle(numbers.sample(k, 0), numbers.sample(k, 1));
      const Vec3f direction =
          frame.to_world(sample_cosine_hemisphere(numbers.sample(k, 2), numbers.sample(k, 3)));
      if (const auto account = end_of_ray(rays, points.origin(u, v), direction)) count(leaks[z], *account);
    }
  });
  return ZoneLeaks(std::move(leaks));
}

std::vector<LeakAccount> trace_light_leaks(const PunctualEmitter& light, const RayTracer& rays,
                                           std::uint64_t seed) {
  std::vector<LeakAccount> leaks;
  const SobolSequence numbers(seed);
  for (std::uint32_t k = 0; k < kRaysPerLight; ++k) {
    const LightRay start = start_light_ray(light, numbers.sample(k, 0), numbers.sample(k, 1),
                                           numbers.sample(k, 2), numbers.sample(k, 3));
    if (const auto account = end_of_ray(rays, start.origin, start.direction)) count(leaks, *account);
  }
  return leaks;
}

}  // namespace reemit
