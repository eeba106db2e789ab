#include "solver/progressive_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "solver/gather/discretisation.h"
#include "solver/gather/small_zones.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/matrix/matrix_solve.h"
#include "solver/shoot/closed_room_check.h"
#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_statistics.h"
#include "solver/tally/stop_rule.h"

#include "reemit/version.h"

namespace reemit {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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

bool gathers_small_zones(const Solution& solution) {
  return solution.settings.gather_small_zones && small_zone_count(solution.mesh) > 0;
}

/// Adds batches to `solution` until a rule stops it.
void run_batches(const TransportScene& transport, const Emission& emission, Solution& solution,
                 const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  const SolverSettings& settings = solution.settings;
  SolverSettings limits = settings;
  if (gathers_small_zones(solution)) limits.time_limit_s *= 1 - kSmallZoneShare;
  const StopRule rule(limits, transport.zones());
  const auto start = std::chrono::steady_clock::now();
  SolveRecord& record = solution.record;
  BatchBooks books(transport.zones(), transport.surfaces(), transport.bands());
  for (;;) {
    const auto batch = static_cast<std::uint32_t>(solution.sums.batches);
    const BatchTask task{
        transport, emission, settings, batch, rule.batch_packets(), batch == 0 ? nullptr : &interrupt};
    books.clear();
    const bool whole =
        settings.method == SolveMethod::kShooting ? shoot_batch(task, books) : walk_batch(task, books);
    if (whole) {
      add_batch(solution.mesh, books, emission.watts_per_quantum, solution.sums);
      add_batch(books, solution.audit);
      record.packets += books.packets;
      record.rays += books.rays;
    }
    record.seconds = seconds_since(start);
    record.error = zone_rms_error(transport.scene(), solution.mesh, solution.sums);
    record.error_bound = record.error;
    if (rule.may_reach_target(solution.sums.batches, record.error))
      record.error_bound = zone_error(transport.scene(), solution.mesh, solution.sums).bound;
    const RunState state{solution.sums.batches, record.packets, record.error_bound, record.seconds,
                         interrupt.load()};
    if (progress) {
      const double fraction = rule.fraction_done(state);
      progress({fraction, record.error, static_cast<double>(record.rays) / record.seconds, record.seconds,
                fraction > 0 ? record.seconds * (1 - fraction) / fraction
                             : std::numeric_limits<double>::infinity(),
                record.rays, record.packets, solution.sums.batches});
    }
    if (const auto reason = rule.stop(state)) {
      record.stopped = *reason;
      return;
    }
  }
}

void run_matrix(const TransportScene& transport, const Emission& emission, Solution& solution,
                const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  const auto start = std::chrono::steady_clock::now();
  const auto report = [&](double fraction) {
    if (!progress) return;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    const double seconds = seconds_since(start);
    const double left = fraction > 0 ? seconds * (1 - fraction) / fraction : kUnknown;
    progress({fraction, kUnknown, 0, seconds, left, 0, 0, 0});
  };
  solve_by_matrix(transport, emission, report, interrupt, solution);
  solution.record.seconds = seconds_since(start);
}

}  // namespace

Solution solve(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
               const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  Solution solution = empty_solution(scene, std::move(mesh), settings);
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

  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
  arena.execute([&] {
    const auto start = std::chrono::steady_clock::now();
    if (settings.method == SolveMethod::kMatrix) {
      run_matrix(transport, emission, solution, progress, interrupt);
    } else {
      run_batches(transport, emission, solution, progress, interrupt);
      if (gathers_small_zones(solution)) {
        SmallZoneLimits limits;
        limits.solver_rays =
            kSmallZoneShare / (1 - kSmallZoneShare) * static_cast<double>(solution.record.rays);
        if (settings.time_limit_s > 0) limits.seconds = settings.time_limit_s - seconds_since(start);
        gather_small_zones(scene, rays, limits, solution, interrupt);
      }
    }
    if (!interrupt) solution.record.discretisation = discretisation_error(scene, rays, solution);
    if (!interrupt) solution.record.gather_bias = estimate_zone_bias(scene, rays, solution);
    solution.record.seconds = seconds_since(start);
    const ZoneError error = zone_error(scene, solution.mesh, solution.sums);
    solution.record.error = error.rms;
    solution.record.error_bound = error.bound;
    solution.record.error_95th_percentile = error.percentile_95;
    solution.record.unreached_zones = error.unreached;
  });
  return solution;
}

}  // namespace reemit
