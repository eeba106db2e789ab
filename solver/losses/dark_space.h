#pragma once
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Space before sides that no light came to.
struct DarkSpace {
  /// The front or the back of a surface, as far as it is dark.
  struct Face {
    SurfaceId surface;
    bool front = true;
    double area = 0;  ///< [m2]
  };
  double share = 0;         ///< Of all space that surfaces enclose [0,1].
  std::vector<Face> faces;  ///< That enclose it, largest first.
  /// One of the scene's cameras has a dark side in the middle of its picture.
  bool is_looked_at = false;
};

/// By rays from all sides: the volume before sides is their area times the mean distance to what they see
/// over four. Sides from which more than half of the rays leave the room enclose nothing. A side is dark if
/// it is sealed, or if the same side of its whole surface got no light, so that few packets leave none dark;
/// what emits is not. Deterministic. Throws Interrupted when `stop` (may be null) is requested.
DarkSpace find_dark_space(const PacketRoom& transport, const Solution& solution,
                          const StopToken* stop = nullptr);

}  // namespace reemit
