#include "mesh/zones/total_powers.h"

#include <cmath>
#include <vector>

#include "mesh/zones/solid_areas.h"

namespace reemit {

void spread_total_powers(const MeshReport& report, const ZoneMesh& mesh, Scene& scene) {
  // What rounding takes or adds is no reason to change the light of a room.
  constexpr double kRounding = 1e-9;
  // With less of it left, the lamp is lost (check_dropped_luminaires).
  constexpr double kLeastPower = 1e-6;
  std::vector<double> left(scene.materials.size(), 0.0);  // [m2]
  const std::vector<double> areas = solid_areas(report, mesh);
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    left[scene.surfaces[s].material.index()] += areas[s];
  for (std::size_t m = 0; m < left.size(); ++m) {
    Material& material = scene.materials[m];
    const double area = left[m] * (material.emits_both_sides ? 2 : 1);
    const double read = material.area_of_total_power;
    if (!(read > 0)) continue;  // given as a radiance
    if (!(area > kLeastPower * read) || std::abs(area - read) <= kRounding * read) continue;
    material.emitted_radiance *= read / area;
    material.area_of_total_power = area;
  }
}

}  // namespace reemit
