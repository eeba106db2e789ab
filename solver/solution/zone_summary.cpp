#include "solver/solution/zone_summary.h"

#include <algorithm>

namespace reemit {

ZoneSummary summarise_zones(const ZoneMesh& mesh) {
  ZoneSummary summary;
  summary.zones = mesh.zone_count();
  for (std::size_t z = mesh.cell_zone_count(); z < mesh.zone_count(); ++z) {
    const ZoneId group(z);
    if (mesh.is_sealed(group)) {
      ++summary.sealed;
      summary.sealed_area += mesh.zone_area(group);
    } else {
      ++summary.shared;
      summary.shared_sides += mesh.member_count(group);
    }
  }
  return summary;
}

double sealed_light_share(const Solution& solution) {
  const ZoneMesh& mesh = solution.mesh;
  const std::size_t bands = solution.bands.count();
  double worst = 0;
  for (std::size_t b = 0; b < bands; ++b) {
    double all = 0;
    double sealed = 0;
    for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
      const Channels& channels = solution.sums.channels;
      const double power = mesh.zone_area(ZoneId(z)) * channels.over_groups(b, [&](std::size_t c) {
        return solution.sums.total(z * channels.count() + c);
      });
      all += power;
      if (mesh.is_sealed(ZoneId(z))) sealed += power;
    }
    if (all > 0) worst = std::max(worst, sealed / all);
  }
  return worst;
}

}  // namespace reemit
