#include "solver/progressive_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "scenes/model/interrupted.h"
#include "scenes/model/stop_token.h"
#include "solver/gather/discretisation.h"
#include "solver/gather/small_zones.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/losses/lost_light.h"
#include "solver/losses/luminaire_warnings.h"
#include "solver/matrix/matrix_solve.h"
#include "solver/shoot/closed_room_check.h"
#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_statistics.h"
#include "solver/tally/stop_rule.h"

#include "reemit/version.h"

namespace reemit {
namespace {

using Clock = StopToken::Clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double kUnknown = std::numeric_limits<double>::infinity();

Solution empty_solution(const Scene& scene, MeshResult mesh, const SolverSettings& settings) {
  Solution solution;
  solution.program_version = kProgramVersion;
  solution.room_hash = content_hash(scene);
  solution.settings = settings;
  solution.bands = scene.bands;
  keep_surfaces(scene, solution);
  solution.mesh_report = std::move(mesh.report);
  solution.mesh = std::move(mesh.mesh);
  solution.sums.clear(solution.mesh.zone_count() * scene.bands.count());
  for (const std::string& name : scene.bands.names()) {
    BandAudit& band = solution.audit.bands.emplace_back();
    band.band = name;
    band.absorbed.assign(scene.surfaces.size(), 0);
    band.absorbed_on_backs.assign(scene.surfaces.size(), 0);
  }
  return solution;
}

/// Share of all rays, and of the time, that goes to gathering on small zones at most.
constexpr double kSmallZoneShare = 0.15;
/// Share of the time that is kept for what comes after batches and gathering: the error and the
/// discretisation.
constexpr double kLastShare = 0.03;

bool gathers_small_zones(const Solution& solution) {
  return solution.settings.gather_small_zones && small_zone_count(solution.mesh) > 0;
}

/// When the parts of a run must be over; never, without a time limit.
struct Schedule {
  Clock::time_point start;
  double limit_s = 0;  ///< 0: no limit.
  double batches_s = 0;
  double gather_s = 0;

  Schedule(Clock::time_point begin, const Solution& solution)
      : start(begin), limit_s(solution.settings.time_limit_s) {
    gather_s = limit_s * (1 - kLastShare);
    batches_s = gather_s - (gathers_small_zones(solution) ? kSmallZoneShare * limit_s : 0.0);
  }

  StopToken token(double seconds, const std::atomic<bool>& interrupt) const {
    if (!(limit_s > 0)) return StopToken(interrupt);
    // Beyond what a clock can count there is no limit either.
    constexpr double kLongest = 1e9;
    const std::chrono::duration<double> span(std::min(seconds, kLongest));
    return StopToken(interrupt, start + std::chrono::duration_cast<Clock::duration>(span));
  }
};

/// Adds batches to a solution until a rule stops it.
class BatchRun {
 public:
  BatchRun(const TransportScene& transport, const Emission& emission, const Schedule& schedule,
           Solution& solution)
      : transport_(transport),
        emission_(emission),
        schedule_(schedule),
        solution_(solution),
        plan_(solution.settings, transport.zones()),
        rule_(solution.settings, plan_, schedule.batches_s),
        books_(transport.zones(), transport.surfaces(), transport.bands()) {}

  void run(const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
    // A batch that was foreseen to end in time may take a little longer, and a slow start must leave time for
    // some light at least.
    constexpr double kGrace = 0.01;
    constexpr double kLeast = 0.1;
    state_.seconds = seconds_since(schedule_.start);
    const double end = std::max(schedule_.batches_s + kGrace * schedule_.limit_s,
                                state_.seconds + kLeast * schedule_.limit_s);
    const StopToken stop = schedule_.token(end, interrupt);
    std::optional<StopReason> reason;
    while (!reason) {
      const bool whole = add(stop);
      if (progress) report(progress);
      reason = rule_.stop(state_);
      if (!whole) reason = stop.interrupted() ? StopReason::kInterrupted : StopReason::kTimeLimit;
      if (interrupt) reason = StopReason::kInterrupted;
    }
    solution_.record.stopped = *reason;
  }

 private:
  /// Runs the next batch; false if it was cut off.
  bool add(const StopToken& stop) {
    const SolverSettings& settings = solution_.settings;
    SolveRecord& record = solution_.record;
    const std::int64_t weight = rule_.next_weight(state_);
    state_.shortened = weight < plan_.next_weight(state_.batches, state_.weight);
    const auto packets = static_cast<std::uint32_t>(weight * plan_.unit_packets());
    const BatchTask task{transport_, emission_, settings, static_cast<std::uint32_t>(state_.batches),
                         packets,    &stop};
    books_.clear();
    const bool whole =
        settings.method == SolveMethod::kShooting ? shoot_batch(task, books_) : walk_batch(task, books_);
    const bool counts = whole || state_.batches == 0;
    if (counts) {
      add_batch(solution_.mesh, books_, emission_.watts_per_quantum, weight, solution_.sums);
      add_batch(books_, weight, solution_.audit);
      record.packets += books_.packets;
      record.rays += books_.rays;
      state_.weight += weight;
      state_.batches = solution_.sums.batches;
    }
    if (counts) {
      record.error = zone_rms_error(transport_.scene(), solution_.mesh, solution_.sums);
      state_.error = record.error;
      look_at_bound();
    }
    state_.unshot_share = solution_.audit.worst_unshot_share();
    const double before = std::exchange(state_.seconds, seconds_since(schedule_.start));
    state_.batch_seconds = (state_.seconds - before) / static_cast<double>(weight);
    record.seconds = state_.seconds;
    return whole;
  }

  /// The bound takes a longer look than the error: where it may end the run, and for information whenever the
  /// work has doubled.
  void look_at_bound() {
    const bool decides = rule_.may_reach_target(state_.batches, record().error);
    if (!decides && state_.weight < 2 * weight_of_bound_) return;
    bound_ = zone_error(transport_.scene(), solution_.mesh, solution_.sums).bound;
    weight_of_bound_ = state_.weight;
    if (decides) state_.error = bound_;
  }

  void report(const ProgressCallback& progress) const {
    const double fraction = rule_.fraction_done(state_);
    SolveProgress now;
    now.fraction = fraction;
    now.error = record().error;
    now.error_bound = bound_;
    now.unshot_share = state_.unshot_share;
    now.rays_per_second = static_cast<double>(record().rays) / record().seconds;
    now.seconds = record().seconds;
    now.seconds_left = fraction > 0 ? now.seconds * (1 - fraction) / fraction : kUnknown;
    now.rays = record().rays;
    now.packets = record().packets;
    now.batches = state_.batches;
    progress(now);
  }

  const SolveRecord& record() const { return solution_.record; }

  const TransportScene& transport_;
  const Emission& emission_;
  const Schedule& schedule_;
  Solution& solution_;
  BatchPlan plan_;
  StopRule rule_;
  BatchBooks books_;
  RunState state_;
  double bound_ = kUnknown;
  std::int64_t weight_of_bound_ = 0;  // when bound_ was looked at
};

/// Light on small zones, which follows the batches and takes time of its own.
void gather_what_is_small(const Scene& scene, const RayScene& rays, const Schedule& schedule,
                          const std::atomic<bool>& interrupt, Solution& solution) {
  if (interrupt || !gathers_small_zones(solution)) return;
  SolveRecord& record = solution.record;
  SmallZoneLimits limits;
  limits.solver_rays = kSmallZoneShare / (1 - kSmallZoneShare) * static_cast<double>(record.rays);
  if (schedule.limit_s > 0) limits.seconds = schedule.gather_s - seconds_since(schedule.start);
  const bool clock_had_a_say =
      gather_small_zones(scene, rays, limits, solution, schedule.token(schedule.gather_s, interrupt));
  if (clock_had_a_say && !interrupt) record.stopped = StopReason::kTimeLimit;
}

/// How far points differ from the zones they are in.
void compare_points_with_zones(const Scene& scene, const RayScene& rays, const Schedule& schedule,
                               const std::atomic<bool>& interrupt, Solution& solution) {
  SolveRecord& record = solution.record;
  if (solution.settings.method == SolveMethod::kMatrix) {
    record.discretisation = discretisation_error(scene, rays, solution, StopToken(interrupt));
    record.gather_bias = estimate_zone_bias(scene, rays, solution, StopToken(interrupt));
    return;
  }
  // Short runs may spend a moment more on it.
  constexpr double kMoment = 0.5;
  const StopToken stop = schedule.token(schedule.limit_s + kMoment, interrupt);
  record.discretisation = discretisation_error(scene, rays, solution, stop);
  record.gather_bias = estimate_zone_bias(scene, rays, solution, stop);
}

void tell_of_examination(const Solution& solution, const ProgressCallback& progress) {
  SolveProgress now;
  now.fraction = 1;
  now.error = solution.record.error;
  now.error_bound = kUnknown;
  now.unshot_share = solution.audit.worst_unshot_share();
  now.seconds = solution.record.seconds;
  now.seconds_left = kUnknown;
  now.rays = solution.record.rays;
  now.packets = solution.record.packets;
  now.batches = solution.sums.batches;
  now.examines = true;
  progress(now);
}

/// Where light is lost, or that nobody looked.
void look_for_lost_light(const TransportScene& transport, const Emission& emission,
                         const std::atomic<bool>& interrupt, Solution& solution) {
  const StopToken stop(interrupt);
  std::vector<std::string>& warnings = solution.light_warnings;
  try {
    warnings = luminaire_warnings(transport, emission, &stop);
    for (std::string& warning : lost_light_warnings(transport, emission, solution, &stop))
      warnings.push_back(std::move(warning));
  } catch (const Interrupted&) {
    warnings.push_back(
        "the run was interrupted before it had looked for light that is lost; solve again to know");
  }
}

void run_matrix(const TransportScene& transport, const Emission& emission, Solution& solution,
                const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  const auto start = Clock::now();
  const auto report = [&](double fraction) {
    if (!progress) return;
    SolveProgress now;
    now.fraction = fraction;
    now.error = now.error_bound = kUnknown;
    now.seconds = seconds_since(start);
    now.seconds_left = fraction > 0 ? now.seconds * (1 - fraction) / fraction : kUnknown;
    progress(now);
  };
  solve_by_matrix(transport, emission, report, interrupt, solution);
  solution.record.seconds = seconds_since(start);
}

/// `examine`: find out how good the solution is, beyond its noise, and where light is lost.
Solution solve_room(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
                    const ProgressCallback& progress, const std::atomic<bool>& interrupt,
                    const WorkWatch& preparing, bool examine) {
  const auto start = Clock::now();
  Solution solution = empty_solution(scene, std::move(mesh), settings);
  preparing.at(0);
  const RayScene rays(solution.mesh);
  const TransportScene transport(scene, solution.mesh, rays);
  const Emission emission = collect_emission(transport);
  for (std::size_t b = 0; b < scene.bands.count(); ++b)
    solution.audit.bands[b].watts_per_quantum = emission.watts_per_quantum[b];
  if (emission.sources.empty()) {
    solution.record.stopped = StopReason::kNoLuminaire;
    solution.record.unreached_zones = solution.mesh.zone_count();
    return solution;
  }
  refuse_closed_perfect_reflector(transport, emission, settings.seed);
  preparing.at(1);

  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  arena.execute([&] {
    const Schedule schedule(start, solution);
    if (settings.method == SolveMethod::kMatrix) {
      run_matrix(transport, emission, solution, progress, interrupt);
    } else {
      BatchRun(transport, emission, schedule, solution).run(progress, interrupt);
      gather_what_is_small(scene, rays, schedule, interrupt, solution);
    }
    if (examine && progress && !interrupt) tell_of_examination(solution, progress);
    if (examine) compare_points_with_zones(scene, rays, schedule, interrupt, solution);
    const ZoneError error = zone_error(scene, solution.mesh, solution.sums);
    solution.record.error = error.rms;
    solution.record.error_bound = error.bound;
    solution.record.error_95th_percentile = error.percentile_95;
    solution.record.unreached_zones = error.unreached;
    solution.record.seconds = seconds_since(start);
  });
  if (!examine) return solution;
  look_for_lost_light(transport, emission, interrupt, solution);
  return solution;
}

}  // namespace

Solution solve(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
               const ProgressCallback& progress, const std::atomic<bool>& interrupt,
               const WorkWatch& preparing) {
  return solve_room(scene, std::move(mesh), settings, progress, interrupt, preparing, true);
}

Solution solve_zones(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
                     const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  return solve_room(scene, std::move(mesh), settings, progress, interrupt, {}, false);
}

}  // namespace reemit
