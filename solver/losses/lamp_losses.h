#pragma once
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// Luminous surfaces of one material whose boxes touch, taken for one lamp, whose light meets the lamp first.
struct SelfLitLuminaire {
  std::vector<SurfaceId> surfaces;
  double share = 0;  ///< Of its power that does and is not let through [0,1].
};

/// Lamps smaller than the room that send a quarter of their power or more onto themselves: closed ones whose
/// inner side emits. A room whose walls emit is none. The error of a share is 2 % at most. Throws Interrupted
/// when `stop` (may be null) is requested.
std::vector<SelfLitLuminaire> self_lit_luminaires(const PacketRoom& transport, const PacketSources& emission,
                                                  const StopToken* stop = nullptr);

}  // namespace reemit
