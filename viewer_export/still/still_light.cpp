#include "viewer_export/still/still_light.h"

#include <algorithm>
#include <bit>

#include <tbb/task_arena.h>

#include "solver/solution/room_of_solution.h"
#include "solver/solution/thread_count.h"
#include "viewer_export/still/film.h"

namespace reemit {
namespace {

std::size_t replicates_of(const StillSettings& settings) {
  const int most = settings.error_target > 0 ? settings.most_spp : settings.spp;
  return std::min(Film::kReplicates, std::bit_floor(static_cast<std::size_t>(most)));
}

}  // namespace

std::unique_ptr<StillLight> StillLight::prepare(const Room& room, const Solution& solution,
                                                const StillSettings& settings,
                                                const std::atomic<bool>& interrupt) {
  check(settings);
  check_is_room_of(solution, room.scene(), room.mesh());
  tbb::task_arena arena(thread_count(settings.threads));
  return arena.execute([&] {
    const StopToken stop(interrupt);
    return std::unique_ptr<StillLight>(new StillLight(room, solution, settings, stop));
  });
}

StillLight::StillLight(const Room& room, const Solution& solution, const StillSettings& settings,
                       const StopToken& stop)
    : room_(&room),
      solution_(&solution),
      settings_(settings),
      replicates_(replicates_of(settings)),
      field_(room, solution, settings.integrator == Integrator::kPath ? 1 : replicates_),
      direct_(room, {settings.light_selection}),
      gather_(field_, direct_,
              // The other integrators gather nothing; without close hits there is nothing to prepare.
              GatherSettings{.close_hit = settings.integrator == Integrator::kGather ? settings.close_hit : 0,
                             .caustics = settings.integrator == Integrator::kGather,
                             .aim_at_bright = settings.integrator == Integrator::kGather,
                             .seed = settings.seed,
                             .plan = &solution.gather_plan},
              &stop),
      path_(room, direct_, settings.seed) {}

}  // namespace reemit
