#include "solver/zoning/light_on_sides.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/gather/direct_light.h"
#include "solver/gather/light_spread.h"
#include "solver/gather/point_sampler.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

constexpr std::uint64_t kLookSeed = 1;  // nothing of a solution should depend on it
/// Points on a side as large as a zone, and on any.
constexpr double kPointsPerZone = 4;
constexpr int kLeastPoints = 2;
constexpr int kMostPoints = 64;
/// Radiance over the mean of the room below which differences no longer matter relative to it.
constexpr double kDim = 0.3;
/// Shadow rays from each point, in halves whose noise is independent.
constexpr std::size_t kHalves = 2;

/// Reflected direct radiance on one side, all bands together.
struct Radiance {
  double mean = 0;
  double variance = 0;  // over the side; an estimate, may be below 0
};

/// `found` holds a value for each band and is overwritten.
Radiance look(const Room& room, const DirectLight& direct, SideId side, int points,
              std::vector<float>& found) {
  const float* reflectance = room.surfaces().reflectance(triangle_of(side), is_front(side));
  const PointSampler place(kLookSeed, RngPurpose::kLightOnSides, side.index(), kHalves,
                           std::countr_zero(std::bit_ceil(static_cast<unsigned>(points))));
  LightSpread light;
  for (int i = 0; i < points; ++i) {
    const std::array<float, 2> u = place.place(i);
    const auto [a, b] = sample_triangle(u[0], u[1]);
    const SurfacePoint x = surface_point(room.rays(), triangle_of(side), a, b, is_front(side));
    std::array<double, kHalves> sum{};
    for (std::size_t half = 0; half < kHalves; ++half) {
      std::fill(found.begin(), found.end(), 0.0F);
      direct.add_sample(x, place.light(i, static_cast<int>(half), kHalves), reflectance, found.data());
      for (const float f : found) sum[half] += static_cast<double>(f);
    }
    light.add(sum[0], sum[1]);
  }
  return {light.mean(), light.variance()};
}

}  // namespace

std::vector<SideLightness> light_on_sides(const Room& room, const std::vector<SideUse>& uses,
                                          double zone_area, const WorkWatch& watch) {
  const ZoneMesh& mesh = room.mesh();
  std::vector<SideLightness> result(uses.size());
  const DirectLight direct(room);
  if (direct.empty()) return result;
  const auto counts = [&](std::size_t s) { return uses[s] != SideUse::kSealed && mesh.has_zones(SideId(s)); };
  std::vector<Radiance> radiance(uses.size());
  constexpr std::size_t kSidesPerStep = 1 << 16;
  for (std::size_t begin = 0; begin < uses.size(); begin += kSidesPerStep) {
    watch.at(static_cast<double>(begin) / static_cast<double>(uses.size()));
    const std::size_t end = std::min(begin + kSidesPerStep, uses.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 256), [&](const auto& range) {
      std::vector<float> found(room.band_count());
      for (std::size_t s = range.begin(); s != range.end(); ++s) {
        if (!counts(s)) continue;
        const double wanted = kPointsPerZone * mesh.triangle_area(triangle_of(SideId(s))) / zone_area;
        const int points = static_cast<int>(std::clamp<double>(wanted, kLeastPoints, kMostPoints));
        radiance[s] = look(room, direct, SideId(s), points, found);
      }
    });
  }
  double area = 0;
  double power = 0;
  for (std::size_t s = 0; s < uses.size(); ++s) {
    if (!counts(s)) continue;
    const double a = mesh.triangle_area(triangle_of(SideId(s)));
    area += a;
    power += a * radiance[s].mean;
  }
  if (!(power > 0)) return result;
  const double dim = kDim * power / area;
  for (std::size_t s = 0; s < uses.size(); ++s) {
    const double level = dim + radiance[s].mean;
    result[s] = {static_cast<float>(std::log(level / dim)),
                 static_cast<float>(std::max(0.0, radiance[s].variance) / (level * level))};
  }
  return result;
}

}  // namespace reemit
