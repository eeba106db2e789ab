#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// How many zones are so small that packets leave them clearly noisier than the rest: less than a ninth of
/// the mean zone area, which at equal light means more than three times the error.
std::size_t small_zone_count(const ZoneMesh& mesh);
/// All others, by number.
std::vector<ZoneId> zones_left_to_packets(const ZoneMesh& mesh);

/// How much work gathering on small zones may be.
struct SmallZoneLimits {
  double solver_rays = 0;         ///< As much as this many rays of packets cost.
  std::optional<double> seconds;  ///< Wall time [s].
  /// Packets brought little of the direct light: it is known well, and that of the packets is indirect.
  bool direct_is_sampled = false;
};

/// Gives zones too small to meet enough packets their irradiance by gathering from the rest of the zone
/// solution, as [GI98] (Monte Carlo notes) proposes: rays from uniform points of the zone read the zones they
/// hit, one replicate per batch group, so that the standard error holds the noise of the zones read. Near
/// hits (GatherSettings::close_hit) and those on uneven zones are continued, unless the run has
/// Reemission::kFromZones: then it is the equation of the zonal system, E_i = sum_j F_ij B_j. Caustics, which
/// few gather rays would find, stay those that packets brought, as do the inner sides of bodies of glass. A
/// short pilot gather of every small zone, with random numbers of its own, foresees whether gathering it will
/// beat its packets. Zones whose gather turns out to have more noise than packets, or to differ from them by
/// more than chance, as where few rays meet a bright spot, keep what packets brought; light that is missed by
/// less than packets can tell stays missed (docs/estimators.md). `limits` bound the work, but for zones
/// that packets are not to be expected to meet even once, for which up to half a second is spent in any case.
/// Adds to record.rays and sets record.gathered_zones. Returns true if the clock had a say in what was
/// gathered, by the limit or by `stop`. Does nothing with fewer than ZoneSums::kGroups batches. When `stop`
/// is requested the zones not yet done keep what packets found.
bool gather_small_zones(const Room& room, const SmallZoneLimits& limits, Solution& solution,
                        const StopToken& stop);

}  // namespace reemit
