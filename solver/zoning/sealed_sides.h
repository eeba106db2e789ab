#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/work_watch.h"
#include "solver/room/room.h"

namespace reemit {

/// By side of a base triangle (2 * triangle, + 1 for the back), 1 if no light reaches it: insides of closed
/// solids, faces between things that touch, voids without a luminaire. Rays from points all over the sides
/// join each side with what it sees; what no chain of such rays joins with a luminaire, or with the outside
/// if light comes from there, is sealed. Sides without zones are 0. The same for any number of threads.
/// Means of textures may have been left out of the room. Throws Interrupted when `watch` ends it.
std::vector<std::uint8_t> sealed_sides(const Room& room, const WorkWatch& watch = {});

}  // namespace reemit
