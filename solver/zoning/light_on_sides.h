#pragma once
#include <vector>

#include "mesh/zones/zone_plan.h"
#include "scenes/model/work_watch.h"
#include "solver/room/room.h"

namespace reemit {

/// By side of a base triangle, how direct light lies on it, for plan_zones; nothing on sides that are sealed.
/// A few shadow rays from each, more from large ones. `zone_area`: of zones that one would cut the room into
/// [m2]. The same for any number of threads. Throws Interrupted when `watch` ends it.
std::vector<SideLightness> light_on_sides(const Room& room, const std::vector<SideUse>& uses,
                                          double zone_area, const WorkWatch& watch);

}  // namespace reemit
