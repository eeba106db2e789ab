#include "mesh/zones/solid_areas.h"

namespace reemit {

std::vector<double> solid_areas(const MeshReport& report, const ZoneMesh& mesh) {
  std::vector<double> areas;
  for (const SurfaceAreas& surface : report.surfaces) areas.push_back(surface.meshed);
  if (mesh.solid_shares().empty()) return areas;
  struct Sums {
    double all = 0, solid = 0;  // of the zones on the front [m2]
  };
  std::vector<Sums> sums(areas.size());
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    if (!mesh.zone_shows_front(z)) continue;
    Sums& of = sums[mesh.zone_surface(z).index()];
    of.solid += mesh.zone_area(z);
    of.all += mesh.zone_area(z) / mesh.solid_share(z);
  }
  for (std::size_t s = 0; s < areas.size(); ++s)
    if (sums[s].solid < sums[s].all) areas[s] *= sums[s].solid / sums[s].all;
  return areas;
}

}  // namespace reemit
