#pragma once
#include <cstdint>
#include <vector>

#include "solver/emit/punctual_emitter.h"
#include "solver/matrix/symmetric_table.h"
#include "solver/shoot/packet_room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Mean irradiance of the zones by one luminaire without area, per unit of its intensity (or of its
/// irradiance across the beam), in independent replicates.
struct PunctualIrradiance {
  static constexpr std::size_t kReplicates = ZoneSums::kGroups;
  static constexpr std::uint64_t kRaysPerZone = 256;
  RowMatrix of_zone;    ///< [1/m2], or [1] for a directional light: zone x replicate.
  double arriving = 0;  ///< Sum over zones of area times mean: the power that arrives per unit.
};

/// By 16 scrambles of 16 points per zone with a shadow ray each. If `power_per_unit` > 0, all of that power
/// is known to arrive, and each replicate is scaled such that it does. Deterministic; runs in the arena of
/// the caller.
PunctualIrradiance punctual_irradiance(const PunctualEmitter& light, const PacketRoom& transport,
                                       std::uint64_t seed, double power_per_unit);

}  // namespace reemit
