#pragma once
#include <vector>

#include "scenes/model/camera.h"
#include "solver/room/room.h"

namespace reemit {

/// One to three cameras for a room that has none, named auto-1, auto-2, ..., upright and level. Eyes stand
/// where light goes, so never in solids or voids nor, unless the room is open, outside of it; at the height
/// of a standing person as far as there is room, and clear of surfaces. Of all views those are taken that
/// show most: lit surfaces of many kinds, far away, with nothing before the eye; each further one by what it
/// shows that those before it do not. A room without free space (a lone polygon) is shown from outside. Some
/// 150,000 rays; deterministic. Pre: `rays` has triangles.
std::vector<Camera> default_cameras(const Room& room);

}  // namespace reemit
