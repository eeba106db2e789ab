#pragma once
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// Luminous surfaces of one material whose boxes touch, taken for one lamp, that lose much of their light at
/// once. Shares of its power [0,1].
struct LampLoss {
  std::vector<SurfaceId> surfaces;
  double onto_itself = 0;  ///< Meets the lamp first and is not let through.
  double outside = 0;      ///< Of parts from which nothing but the open is seen.
  bool shines_onto_itself = false;
  bool stands_across = false;  ///< Through a ceiling or a wall.
};

/// Lamps smaller than the room that send a quarter of their power or more onto themselves: closed ones whose
/// inner side emits; a room whose walls emit is none. And lamps that send a twentieth or more into the open
/// from parts that see nothing else, while most of what the others send meets something: those that are
/// half sunk into a ceiling. The error of a share is 2 % at most.
/// Throws Interrupted when `stop` (may be null) is requested.
std::vector<LampLoss> lamp_losses(const PacketRoom& transport, const PacketSources& emission,
                                  const StopToken* stop = nullptr);

}  // namespace reemit
