#include "mesh/zones/zone_sizing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

/// Divisions are rounded up, so zones come out smaller than wanted, by this much in the mean.
constexpr double kRounding = 1.4;

}  // namespace

double wanted_zone_area(const MeshSettings& settings, double zoned_area) {
  if (settings.zone_area) {
    if (!(*settings.zone_area > 0) || !std::isfinite(*settings.zone_area))
      throw InputError("zone area", fmt::format("{} m2 is not a positive area", *settings.zone_area),
                       "give the largest zone area in square metres, as in 0.01");
    return *settings.zone_area;
  }
  if (settings.default_zone_count < 1 || settings.default_zone_count > 100'000'000)
    throw InputError("default zone count", fmt::format("{} is out of range", settings.default_zone_count),
                     "use a number from 1 to 1e8");
  return kRounding * zoned_area / settings.default_zone_count;
}

double wanted_zone_count(const MeshSettings& settings, double zoned_area) {
  return settings.zone_area ? kRounding * zoned_area / *settings.zone_area : settings.default_zone_count;
}

std::uint32_t divisions_at_least(double n) {
  double power = 1;  // 2^k
  while (power < n) {
    if (power >= 2 && 1.5 * power >= n) return static_cast<std::uint32_t>(1.5 * power);
    power *= 2;
  }
  return static_cast<std::uint32_t>(power);
}

double wanted_divisions(double area, double zone_area) {
  return std::sqrt(area / zone_area) * (1 - 1e-12);  // a zone of just the wanted area is fine
}

void size_zones(BaseMesh& mesh, double zone_area, const std::vector<bool>& dark) {
  constexpr double kMostZones = 2147483648.0;
  std::vector<CurvedPatches> curved;
  for (const CurvedShape& shape : mesh.shapes) curved.emplace_back(shape);
  std::size_t patches = 0;
  for (const CurvedPatches& shape : curved) patches += shape.count();
  // Round things should look round where their zones become vertices, if that is cheap.
  constexpr std::size_t kCheap = 20'000;  // zones
  std::uint32_t least = 4;
  while (least > 1 && patches * least * least > kCheap) least /= 2;
  double zones = 0;
  for (BaseTriangle& t : mesh.triangles) {
    const double area = t.is_curved() ? curved[t.shape].patch_area()
                                      : triangle_area(mesh.vertices[t.vertex[0]], mesh.vertices[t.vertex[1]],
                                                      mesh.vertices[t.vertex[2]]);
    const TriangleId id(static_cast<std::size_t>(&t - mesh.triangles.data()));
    if (!dark.empty() && dark[id.index()]) {
      zones += (t.two_sided ? 2.0 : 1.0) * t.divisions * t.divisions;
      continue;
    }
    const double n = wanted_divisions(area, zone_area);
    if (n < 65536) t.divisions = divisions_at_least(t.is_curved() ? std::max<double>(n, least) : n);
    zones += n < 65536 ? (t.two_sided ? 2.0 : 1.0) * t.divisions * t.divisions : kMostZones;
    if (zones >= kMostZones)
      throw InputError("zone area",
                       fmt::format("zones of at most {:.3g} m2 would be more than 2^31", zone_area),
                       "ask for larger zones, or check the unit of length of the room");
  }
}

}  // namespace reemit
