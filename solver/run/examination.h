#pragma once
#include <atomic>

#include "solver/run/prepared_room.h"
#include "solver/run/schedule.h"

namespace reemit {

// What is done with the zones once the last batch is in.

/// Notes the noise of the zones as it stands in the record.
void record_error(const SurfaceModel& surfaces, Solution& solution);

/// Light on small zones, which follows the batches and takes time of its own. `direct_is_sampled`: of
/// SmallZoneLimits.
void gather_what_is_small(const Room& room, bool direct_is_sampled, const Schedule& schedule,
                          const std::atomic<bool>& interrupt, Solution& solution);

/// Looks at the zones as those will who gather light from them: which of them mislead, how far points differ
/// from the zones they are in, and which packets come over mirrors.
void examine_zones(const Room& room, const Schedule& schedule, const std::atomic<bool>& interrupt,
                   Solution& solution);

/// Notes where light is lost, or that nobody looked.
void look_for_lost_light(const PreparedRoom& room, const std::atomic<bool>& interrupt, Solution& solution);

}  // namespace reemit
