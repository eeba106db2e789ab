#pragma once
#include "scenes/model/stop_token.h"
#include "solver/gather/radiance_field.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

// Fill in the parts of Solution::gather_plan, with the seed of the solution. The plan has no such part when
// `stop` was requested, and keeps none that it had.

/// Zones that gather rays are continued from: uneven_zones(). `field`: of the solution, in as many parts as
/// there are, as gathers read it.
void plan_uneven_zones(const RadianceField& field, const StopToken& stop, Solution& solution);

/// Packets that bring light over mirrors and glass, in rooms that have any.
void plan_caustic_packets(const Room& room, const StopToken& stop, Solution& solution);

}  // namespace reemit
