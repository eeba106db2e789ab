#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_room.h"

namespace reemit {

/// What becomes of the light of a point, spot or measured luminaire on its first flight, by packets drawn as
/// the solver draws them. Shares of its power [0,1].
struct OpeningLoss {
  std::uint32_t light = 0;  ///< Index into Scene::lights.
  /// On backs of one-sided faces, beyond a surface through the opening, or all of it if the light is outside
  /// of a room: behind faces with the open before them and the room behind; if it meets nothing at all; or if
  /// it is shut in by something small.
  double lost = 0;
  double beyond = 0;    ///< Part of `lost`: starts or goes beyond a surface that crosses the opening.
  double touching = 0;  ///< Falls on the point of a surface that a lamp without size stands on.
  double seen = 0;      ///< Meets a side that reflects in the room, and is none of the above.
  SurfaceId surface;    ///< Took, or cut off, most of what is lost; or what the lamp lies in; else not valid.
  bool meets_nothing = false;  ///< 99.9 % and more leave the room at once.
  bool is_shut_in = false;     ///< In a body much thinner than the room, which none of its light leaves.
};

/// Of all luminaires without area but directional ones, those that lose more than one part in 1000 or lie in
/// a surface. The error of a share is 1 % at most (4096 packets each; at least 64 where there are very many
/// luminaires). Throws Interrupted when `stop` (may be null) is requested.
std::vector<OpeningLoss> opening_losses(const PacketRoom& transport, const StopToken* stop = nullptr);

}  // namespace reemit
