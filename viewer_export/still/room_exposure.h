#pragma once
#include <atomic>

#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/output/tone_map.h"

namespace reemit {

/// The tone map for pictures of a room that are not taken from one place, such as exported vertices: that of
/// the room's first still, which `reemit render` makes unless told otherwise, gathered small and with a few
/// samples. So an export is as bright as that picture, and surfaces that it does not show, inside and under
/// things or in the dark next door, do not count. `threads`, `interrupt` and exceptions as of render_still
/// and make_tone_map.
ToneMap tone_map_of_room(const Room& room, const Solution& solution, const ToneMapSettings& settings,
                         int threads, const std::atomic<bool>& interrupt);

}  // namespace reemit
