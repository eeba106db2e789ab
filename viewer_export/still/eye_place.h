#pragma once
#include <string>

#include "scenes/model/camera.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// What the user should know about where a camera stands: in a solid or a wall, outside of the room, where no
/// light comes, or where it sees nothing; one sentence without the camera's name. Empty where all is well,
/// also for an eye before an opening that looks in. Judged by rays to all sides and into the picture: an eye
/// at the wrong place meets sides without light and backs of one-sided faces alone.
std::string eye_warning(const Camera& camera, const Room& room, const Solution& solution);

}  // namespace reemit
