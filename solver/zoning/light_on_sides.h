#pragma once
#include <vector>

#include "mesh/zones/zone_plan.h"
#include "scenes/model/work_watch.h"
#include "solver/zoning/pilot_light.h"

namespace reemit {

/// By side of a base triangle, the level of the light on it (light_level.h), a guess from a few rays, for
/// plan_zones; only of sides that are kShared, 0 on others. The same for any number of threads. Throws
/// Interrupted when `watch` ends it.
std::vector<float> light_on_sides(const PilotLight& pilot, const std::vector<SideUse>& uses,
                                  const WorkWatch& watch);

}  // namespace reemit
