#include "solver/gather/zone_probes.h"

namespace reemit {

std::vector<ZoneProbe> choose_probes(const Solution& solution, std::size_t count, double offset) {
  const ZoneMesh& mesh = solution.mesh;
  std::vector<double> power(mesh.zone_count(), 0.0);
  double total_power = 0;
  double total_area = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const ZoneId zone(z);
    for (std::size_t b = 0; b < solution.bands.count(); ++b)
      power[z] +=
          mesh.zone_area(zone) * solution.zone_reflectance(zone, b) * solution.irradiance(zone, b).mean;
    total_power += power[z];
    total_area += mesh.zone_area(zone);
  }
  std::vector<ZoneProbe> probes;
  if (!(total_power > 0)) return probes;
  const auto number = static_cast<double>(count);
  double passed = 0;
  double next = offset / number;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const double area = mesh.zone_area(ZoneId(z));
    const double share = 0.5 * (power[z] / total_power + area / total_area);
    passed += share;
    for (; next < passed && probes.size() < count; next += 1 / number)
      probes.push_back({ZoneId(z), area / share / number});
  }
  return probes;
}

}  // namespace reemit
