#include "solver/run/examination.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scenes/model/interrupted.h"
#include "scenes/model/stopwatch.h"
#include "solver/gather/discretisation.h"
#include "solver/gather/plan_gathers.h"
#include "solver/gather/radiance_field.h"
#include "solver/gather/small_zones.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/losses/lost_light.h"
#include "solver/losses/luminaire_warnings.h"
#include "solver/tally/batch_statistics.h"

namespace reemit {

void record_error(const SurfaceModel& surfaces, Solution& solution) {
  const ZoneError error = zone_error(surfaces, solution.mesh, solution.sums);
  solution.record.error = error.rms;
  solution.record.error_bound = error.bound;
  solution.record.error_95th_percentile = error.percentile_95;
  solution.record.unreached_zones = error.unreached;
}

void gather_what_is_small(const Room& room, bool direct_is_sampled, const Schedule& schedule,
                          const std::atomic<bool>& interrupt, Solution& solution) {
  if (interrupt || !gathers_small_zones(solution)) return;
  SolveRecord& record = solution.record;
  SmallZoneLimits limits;
  limits.direct_is_sampled = direct_is_sampled;
  // Short runs may do half as much again, or small things that are there to be measured, sensors on a table,
  // would keep the few packets that met them by chance.
  constexpr double kShortRun = 4e6;
  const auto rays = static_cast<double>(record.rays);
  limits.solver_rays =
      std::max(kSmallZoneShare / (1 - kSmallZoneShare) * rays, std::min(rays / 2, kShortRun));
  if (schedule.limit_s > 0) limits.seconds = schedule.gather_s - seconds_since(schedule.start);
  const bool clock_had_a_say =
      gather_small_zones(room, limits, solution, schedule.token(schedule.gather_s, interrupt));
  if (clock_had_a_say && !interrupt) record.stopped = StopReason::kTimeLimit;
}

void examine_zones(const Room& room, const Schedule& schedule, const std::atomic<bool>& interrupt,
                   Solution& solution) {
  // Short runs may spend a moment more on it; the matrix method has no limit.
  constexpr double kMoment = 1;
  constexpr double kRoughShare = 0.1;
  const StopToken stop = solution.settings.method == SolveMethod::kMatrix
                             ? StopToken(interrupt)
                             : schedule.token(schedule.limit_s + kMoment, interrupt);
  const RadianceField field(room, solution, ZoneSums::kGroups);
  plan_uneven_zones(field, stop, solution);
  solution.record.discretisation = discretisation_error(room, solution, stop);
  // Where paths are long the estimate takes more of the time than it should, and what is cut off is lost: if
  // there is a limit a rough one comes first, and the best one last.
  const auto rays = static_cast<double>(solution.record.rays);
  if (schedule.limit_s > 0)
    solution.record.gather_bias =
        estimate_zone_bias(field, solution, ZoneBiasEffort::of(kRoughShare * rays), stop);
  plan_caustic_packets(room, stop, solution);
  if (const auto bias = estimate_zone_bias(field, solution, ZoneBiasEffort::of(rays), stop))
    solution.record.gather_bias = bias;
}

void look_for_lost_light(const PreparedRoom& room, const std::atomic<bool>& interrupt, Solution& solution) {
  const StopToken stop(interrupt);
  std::vector<std::string>& warnings = solution.light_warnings;
  try {
    warnings = luminaire_warnings(room.transport, room.emission, &stop);
    for (std::string& warning : lost_light_warnings(room.transport, room.emission, solution, &stop))
      warnings.push_back(std::move(warning));
  } catch (const Interrupted&) {
    warnings.emplace_back(
        "the run was interrupted before it had looked for light that is lost; solve again to know");
  }
}

}  // namespace reemit
