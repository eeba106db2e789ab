#include "solver/run/prepared_room.h"

#include "solver/losses/open_room.h"
#include "solver/shoot/closed_room_check.h"
#include "solver/texture/zone_means.h"

namespace reemit {

namespace {

/// What zones hold of textures, for all that is printed and exported without the room.
void keep_zone_means(const Room& room, Solution& solution) {
  if (room.surfaces().textures().empty()) return;
  const ZoneMesh& mesh = room.mesh();
  solution.zone_reflectances.clear();
  solution.zone_exitances.clear();
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    const SurfaceId surface = mesh.zone_surface(z);
    const double* rho = room.surfaces().reflectance(z, mesh.zone_triangle(z), mesh.zone_is_front(z));
    solution.zone_reflectances.insert(solution.zone_reflectances.end(), rho, rho + room.band_count());
    Spectrum exitance = room.surfaces().exitance(z, surface);
    if (!room.surfaces().emits(mesh.zone_triangle(z), mesh.zone_is_front(z))) exitance.setZero();
    solution.zone_exitances.insert(solution.zone_exitances.end(), exitance.begin(), exitance.end());
  }
}

}  // namespace

PreparedRoom::PreparedRoom(const Scene& scene, Solution& solution, const WorkWatch& preparing)
    : room((preparing.at(0), measure_cut_outs(scene, solution.mesh), scene), solution.mesh),
      transport(room),
      emission(collect_packet_sources(transport)) {
  for (std::size_t c = 0; c < emission.channels.count(); ++c)
    solution.audit.bands[c].watts_per_quantum = emission.watts_per_quantum[c];
  keep_zone_means(room, solution);
  if (is_dark()) {
    solution.record.stopped = StopReason::kNoLuminaire;
    solution.record.unreached_zones = solution.mesh.zone_count();
  } else {
    refuse_closed_perfect_reflector(transport, emission, solution.settings.seed);
    if (!room.rays().has_left(RayTracer::kMiss) && is_open(transport, emission)) room.believe_misses();
  }
  preparing.at(1);
}

}  // namespace reemit
