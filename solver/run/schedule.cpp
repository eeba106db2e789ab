#include "solver/run/schedule.h"

#include "scenes/model/stopwatch.h"
#include "solver/gather/small_zones.h"

namespace reemit {
namespace {

/// Share of the time that is kept for what comes after batches and gathering: the error, the discretisation
/// and the plan of later gathers, which takes longest in rooms that bend light.
double last_share(const Solution& solution) {
  return solution.sums.has_caustics() ? 0.1 : 0.05;
}

}  // namespace

bool gathers_small_zones(const Solution& solution) {
  // What is gathered tells bands apart, not light groups.
  return solution.settings.gather_small_zones && solution.sums.channels.groups() == 1 &&
         small_zone_count(solution.mesh) > 0;
}

Schedule::Schedule(Clock::time_point begin, const Solution& solution)
    : start(begin),
      limit_s(solution.settings.time_limit_s),
      batches_s(limit_s * (1 - last_share(solution)) -
                (gathers_small_zones(solution) ? kSmallZoneShare * limit_s : 0.0)),
      gather_s(limit_s * (1 - last_share(solution))) {}

StopToken Schedule::token(double seconds, const std::atomic<bool>& interrupt) const {
  if (!(limit_s > 0)) return StopToken(interrupt);
  return StopToken(interrupt, start + clock_duration(seconds));
}

}  // namespace reemit
