#include "solver/run/prepared_room.h"

#include "solver/shoot/closed_room_check.h"

namespace reemit {

PreparedRoom::PreparedRoom(const Scene& scene, Solution& solution, const WorkWatch& preparing)
    : room((preparing.at(0), scene), solution.mesh),
      transport(room),
      emission(collect_packet_sources(transport)) {
  for (std::size_t c = 0; c < emission.channels.count(); ++c)
    solution.audit.bands[c].watts_per_quantum = emission.watts_per_quantum[c];
  if (is_dark()) {
    solution.record.stopped = StopReason::kNoLuminaire;
    solution.record.unreached_zones = solution.mesh.zone_count();
  } else {
    refuse_closed_perfect_reflector(transport, emission, solution.settings.seed);
  }
  preparing.at(1);
}

}  // namespace reemit
