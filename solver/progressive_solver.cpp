#include "solver/progressive_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "scenes/model/stopwatch.h"
#include "solver/gather/sampled_direct_light.h"
#include "solver/matrix/matrix_solve.h"
#include "solver/run/examination.h"
#include "solver/run/prepared_room.h"
#include "solver/run/schedule.h"
#include "solver/shoot/batches_ahead.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/thread_count.h"
#include "solver/tally/batch_statistics.h"
#include "solver/tally/stop_rule.h"

#include "reemit/version.h"

namespace reemit {
namespace {

using Clock = StopToken::Clock;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

EnergyAudit empty_audit(const Solution& solution) {
  EnergyAudit audit;
  const Channels& channels = solution.sums.channels;
  channels.for_each([&](std::size_t channel, std::size_t b) {
    BandAudit& band = audit.bands.emplace_back();
    band.band = solution.bands.name(b);
    if (channels.groups() > 1)
      band.band += " of light group " + std::to_string(channel / channels.bands() + 1);
    band.absorbed.assign(solution.surface_names.size(), 0);
    band.absorbed_on_backs.assign(solution.surface_names.size(), 0);
  });
  return audit;
}

/// What a solution tells of the run so far.
SolveProgress progress_of(const Solution& solution) {
  SolveProgress now;
  now.error = solution.record.error;
  now.error_bound = now.seconds_left = kUnknown;
  now.unshot_share = solution.audit.worst_unshot_share();
  now.seconds = solution.record.seconds;
  if (now.seconds > 0) now.rays_per_second = static_cast<double>(solution.record.rays) / now.seconds;
  now.rays = solution.record.rays;
  now.packets = solution.record.packets;
  now.batches = solution.sums.batches;
  return now;
}

void tell_of_examination(const Solution& solution, const ProgressCallback& progress) {
  SolveProgress now = progress_of(solution);
  now.fraction = 1;
  now.examines = true;
  progress(now);
}

void run_matrix(const PreparedRoom& room, Solution& solution, const ProgressCallback& progress,
                const std::atomic<bool>& interrupt) {
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
  solve_by_matrix(room.transport, room.emission, report, interrupt, solution);
  solution.record.seconds = seconds_since(start);
}

/// What follows the last batch, or the matrix, in the arena of the run.
void examine(const PreparedRoom& room, const Schedule& schedule, const ProgressCallback& progress,
             const std::atomic<bool>& interrupt, Solution& solution) {
  if (progress && !interrupt) tell_of_examination(solution, progress);
  examine_zones(room.room, schedule, interrupt, solution);
}

Solution solve_matrix(const Scene& scene, Solution solution, const SolveWatch& watch,
                      const std::atomic<bool>& interrupt, Examination examination) {
  const auto start = Clock::now();
  check(solution.settings);
  check_is_room_of(solution, scene, solution.mesh);
  const PreparedRoom room(scene, solution, watch.preparing);
  if (room.room.surfaces().any_specular() || room.room.surfaces().any_cut_outs())
    throw InputError(
        scene.source,
        "the room has mirrors, glass or cut-outs, and the matrix method is that of opaque Lambertian "
        "surfaces",
        "Solve it with --method shooting or walk.");
  if (scene.sky)
    throw InputError(scene.source, "the room has a sky, and the matrix method has none",
                     "Solve it with --method shooting or walk.");
  if (room.is_dark()) return solution;
  tbb::task_arena arena(thread_count(solution.settings.threads));
  arena.execute([&] {
    run_matrix(room, solution, watch.progress, interrupt);
    if (examination == Examination::kWhole)
      examine(room, Schedule(start, solution), watch.progress, interrupt, solution);
    record_error(room.room.surfaces(), solution);
    solution.record.seconds = seconds_since(start);
  });
  if (examination == Examination::kWhole) look_for_lost_light(room, interrupt, solution);
  return solution;
}

}  // namespace

Solution new_solution(const Scene& scene, MeshResult mesh, const SolverSettings& settings) {
  check(settings);
  Solution solution;
  solution.program_version = kProgramVersion;
  solution.room_path = scene.source;
  solution.room_hash = content_hash(scene);
  solution.settings = settings;
  solution.bands = scene.bands;
  keep_surfaces(scene, solution);
  solution.mesh_report = std::move(mesh.report);
  solution.mesh = std::move(mesh.mesh);
  solution.sums.clear(solution.mesh.zone_count(), channels_of(scene), scene.bends_light());
  solution.audit = empty_audit(solution);
  return solution;
}

/// Its parts refer to each other, so it is not moved.
class ProgressiveSolver::Run {
 public:
  Run(const Scene& scene, Solution start, const std::atomic<bool>& interrupt, const WorkWatch& preparing)
      : interrupt_(interrupt),
        solution_(prepared_to_go_on(scene, std::move(start))),
        begin_(seconds_ago(solution_.record.seconds)),
        room_(scene, solution_, preparing),
        arena_(thread_count(solution_.settings.threads)),
        schedule_(begin_, solution_),
        plan_(solution_.settings, solution_.mesh.zone_count(), solution_.record.unit_packets),
        rule_(solution_.settings, plan_, schedule_.batches_s) {
    if (room_.is_dark()) return;
    record().unit_packets = plan_.unit_packets();
    arena_.execute([&] {
      direct_ =
          sampled_direct_light(room_.transport, room_.emission, solution_.settings, plan_.unit_packets());
    });
    state_.seconds = seconds_since(begin_);
    stop_.emplace(schedule_.token(end_of_batches(), interrupt));
    ahead_.emplace(room_.transport, room_.emission, solution_.settings, arena_.max_concurrency());
    if (solution_.sums.batches == 0) return;
    state_.batches = solution_.sums.batches;
    state_.weight = solution_.sums.weight();
    if (const std::int64_t last = last_weight(); direct_ && direct_->is_for(last)) prepare_direct();
    arena_.execute([&] { look_at_error(); });
    if (const std::optional<StopReason> reason = rule_.stop(state_)) end_batches(*reason);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool step() {
    if (interrupt_ && state_.batches > 0 && record().stopped == StopReason::kUnderWay)
      end_batches(StopReason::kInterrupted);
    if (record().stopped != StopReason::kUnderWay) return false;
    start_batches();
    std::unique_ptr<BatchesAhead::Batch> batch = ahead_->take();
    arena_.execute([&] { add(*batch); });
    const std::optional<StopReason> reason = reason_to_stop(*batch);
    ahead_->give_back(std::move(batch));
    if (reason) end_batches(*reason);
    return !reason;
  }

  const Solution& solution() const { return solution_; }

  SolveProgress progress() const {
    SolveProgress now = progress_of(solution_);
    now.fraction = rule_.fraction_done(state_);
    now.error_bound = bound_;
    now.seconds = state_.seconds;
    if (now.fraction > 0) now.seconds_left = now.seconds * (1 - now.fraction) / now.fraction;
    return now;
  }

  const Solution& checkpoint() {
    arena_.execute([&] { record_error(room_.room.surfaces(), solution_); });
    return solution_;
  }

  const Room& room() const { return room_.room; }

  void end(const ProgressCallback& progress, Examination examination) {
    if (room_.is_dark() || std::exchange(has_ended_, true)) return;
    if (record().stopped == StopReason::kUnderWay) end_batches(StopReason::kInterrupted);
    arena_.execute([&] {
      gather_what_is_small(room_.room, direct_ && direct_->is_for(last_weight()), schedule_, interrupt_,
                           solution_);
      if (examination == Examination::kWhole) examine(room_, schedule_, progress, interrupt_, solution_);
      record_error(room_.room.surfaces(), solution_);
      record().seconds = seconds_since(begin_);
    });
    if (examination == Examination::kWhole) look_for_lost_light(room_, interrupt_, solution_);
    // What follows the last batch may have been cut off: a run that goes on does it again.
    if (interrupt_) record().stopped = StopReason::kInterrupted;
  }

  Solution hand_over() { return std::move(solution_); }

 private:
  SolveRecord& record() { return solution_.record; }

  /// Takes out what followed the last batch when the solution was finished before.
  static Solution prepared_to_go_on(const Scene& scene, Solution start) {
    check(start.settings);
    check_is_room_of(start, scene, start.mesh);
    SolveRecord& record = start.record;
    if (record.cut_off) {
      // A part of a batch is no independent estimate; it starts again.
      start.sums.clear(start.mesh.zone_count(), start.sums.channels, start.sums.has_caustics());
      start.audit = empty_audit(start);
      const SolveRecord cut_off = std::exchange(record, {});
      record.seconds = cut_off.seconds;
      record.unit_packets = cut_off.unit_packets;
    }
    start.gathered.restore(start.sums);
    record.rays -= start.gathered.rays;
    start.gathered = {};
    record.stopped = StopReason::kUnderWay;
    record.gathered_zones = 0;
    record.discretisation.reset();
    record.gather_bias.reset();
    start.gather_plan = {};
    start.light_warnings.clear();
    return start;
  }

  /// Seconds after the begin at which batches are cut off.
  double end_of_batches() const {
    // One that was foreseen to end in time may take a little longer, and a slow start must leave time for
    // some light at least.
    constexpr double kGrace = 0.01;
    constexpr double kLeast = 0.1;
    const double end = schedule_.batches_s + kGrace * schedule_.limit_s;
    return solution_.sums.batches > 0 ? end : std::max(end, state_.seconds + kLeast * schedule_.limit_s);
  }

  /// Fills the places of batches that go on at the same time with those that will be needed, as far as can be
  /// foreseen.
  void start_batches() {
    while (!ahead_->full()) {
      RunState then = state_;
      then.batches += ahead_->batches();
      then.weight += ahead_->weight();
      then.seconds = seconds_since(begin_);
      std::int64_t weight = drains_ ? 0 : rule_.next_weight(then);
      if (!ahead_->empty() && (weight == 0 || will_suffice(then))) return;
      weight = std::max<std::int64_t>(weight, 1);  // the clock went on since it was looked at
      const auto number = static_cast<std::uint32_t>(then.batches);
      ahead_->start(number, static_cast<std::uint32_t>(weight * plan_.unit_packets()), weight, *stop_,
                    direct_instead(number, weight));
    }
  }

  /// Weight of the last batch, if nothing shortened it.
  std::int64_t last_weight() const {
    return plan_.next_weight(std::max<std::int64_t>(state_.batches, 1) - 1, 0);
  }

  /// From here on direct light is sampled, or left to packets for good.
  void prepare_direct() {
    arena_.execute([&] {
      if (!prepare(room_.transport, room_.emission, solution_.settings, plan_.unit_packets(), *direct_))
        direct_.reset();
    });
  }

  /// How a batch finds direct light, if not by its packets.
  DirectInstead direct_instead(std::uint32_t number, std::int64_t weight) {
    if (!direct_ || !direct_->is_for(weight)) return {};
    if (!direct_->has_looked_at_all()) prepare_direct();
    if (!direct_) return {};
    return {SampledDirectLight::kFirstTogether, [this, number, weight](BatchBooks& books) {
              books.rays += direct_->put(number, weight, room_.emission.watts_per_quantum, books);
            }};
  }

  /// Whether the error target is likely to be met once the batches on their way are added.
  bool will_suffice(const RunState& then) const {
    const double target = solution_.settings.error_target;
    if (!(target > 0) || then.batches < solution_.settings.smallest_batch_count || state_.batches < 2)
      return false;
    const double bound = solution_.record.error * bound_over_error_;
    return bound * std::sqrt(static_cast<double>(state_.weight) / static_cast<double>(then.weight)) <= target;
  }

  void add(const BatchesAhead::Batch& batch) {
    state_.shortened = batch.weight < plan_.next_weight(state_.batches, state_.weight);
    const bool counts = batch.whole || state_.batches == 0;
    if (counts) {
      add_batch(solution_.mesh, batch.books, room_.emission.watts_per_quantum, batch.weight, solution_.sums);
      add_batch(batch.books, batch.weight, solution_.audit);
      record().packets += batch.books.packets;
      record().rays += batch.books.rays;
      record().cut_off = !batch.whole;
      state_.weight += batch.weight;
      state_.batches = solution_.sums.batches;
      look_at_error();
    }
    state_.seconds = seconds_since(begin_);
    state_.batch_seconds = batch.seconds / static_cast<double>(batch.weight);
    record().seconds = state_.seconds;
  }

  void look_at_error() {
    state_.unshot_share = solution_.audit.worst_unshot_share();
    record().error = zone_rms_error(room_.room.surfaces(), solution_.mesh, solution_.sums);
    state_.error = record().error;
    // The bound takes a longer look than the error: where it may end the run, and for information whenever
    // the work has doubled.
    const bool decides = rule_.may_reach_target(state_.batches, record().error);
    if (!decides && state_.weight < 2 * weight_of_bound_) return;
    bound_ = zone_error(room_.room.surfaces(), solution_.mesh, solution_.sums).bound;
    weight_of_bound_ = state_.weight;
    if (std::isfinite(bound_) && record().error > 0) bound_over_error_ = bound_ / record().error;
    if (decides) state_.error = bound_;
  }

  std::optional<StopReason> reason_to_stop(const BatchesAhead::Batch& batch) {
    if (interrupt_) return StopReason::kInterrupted;
    if (!batch.whole) return StopReason::kTimeLimit;
    const std::optional<StopReason> reason = rule_.stop(state_);
    // Those that are on their way were planned to end in time.
    drains_ = reason == StopReason::kTimeLimit && !ahead_->empty();
    return drains_ ? std::nullopt : reason;
  }

  void end_batches(StopReason reason) {
    record().stopped = reason;
    ahead_.reset();
  }

  const std::atomic<bool>& interrupt_;
  Solution solution_;
  Clock::time_point begin_;  // as if earlier sittings had just ended
  PreparedRoom room_;
  tbb::task_arena arena_;
  Schedule schedule_;
  BatchPlan plan_;
  StopRule rule_;
  RunState state_;
  std::optional<StopToken> stop_;
  std::optional<SampledDirectLight> direct_;
  std::optional<BatchesAhead> ahead_;
  bool drains_ = false;     // no more batches begin
  bool has_ended_ = false;  // what follows the last batch is in
  double bound_ = kUnknown;
  double bound_over_error_ = 1;
  std::int64_t weight_of_bound_ = 0;  // when bound_ was looked at
};

ProgressiveSolver::ProgressiveSolver(const Scene& scene, Solution start, const std::atomic<bool>& interrupt,
                                     const WorkWatch& preparing)
    : run_(std::make_unique<Run>(scene, std::move(start), interrupt, preparing)) {}

ProgressiveSolver::~ProgressiveSolver() = default;

bool ProgressiveSolver::step() {
  return run_->step();
}
const Solution& ProgressiveSolver::solution() const {
  return run_->solution();
}
SolveProgress ProgressiveSolver::progress() const {
  return run_->progress();
}
const Solution& ProgressiveSolver::checkpoint() {
  return run_->checkpoint();
}
void ProgressiveSolver::end(const ProgressCallback& progress, Examination examination) {
  run_->end(progress, examination);
}
Solution ProgressiveSolver::finish(const ProgressCallback& progress, Examination examination) {
  run_->end(progress, examination);
  return run_->hand_over();
}
const Room& ProgressiveSolver::room() const {
  return run_->room();
}

std::optional<StopReason> rule_that_holds(const Scene& scene, const Solution& solution) {
  if (solution.record.stopped == StopReason::kNoLuminaire) return StopReason::kNoLuminaire;
  if (solution.sums.batches == 0 || solution.record.cut_off) return std::nullopt;
  const RoomTextures textures(scene, solution.mesh);
  const SurfaceModel surfaces(scene, solution.mesh, textures, 1);
  const auto bound_of = [&](const ZoneSums& sums) { return zone_error(surfaces, solution.mesh, sums).bound; };
  const auto bound_of_packets = [&] {
    ZoneSums sums = solution.sums;
    solution.gathered.restore(sums);
    return bound_of(sums);
  };
  const BatchPlan plan(solution.settings, solution.mesh.zone_count(), solution.record.unit_packets);
  RunState state;
  state.batches = solution.sums.batches;
  state.weight = solution.sums.weight();
  state.error = solution.gathered.zones.empty() ? bound_of(solution.sums) : bound_of_packets();
  state.unshot_share = solution.audit.worst_unshot_share();
  return StopRule(solution.settings, plan, solution.settings.time_limit_s).stop(state);
}

Solution solve(const Scene& scene, Solution start, const SolveWatch& watch,
               const std::atomic<bool>& interrupt, Examination examination) {
  if (start.settings.method == SolveMethod::kMatrix)
    return solve_matrix(scene, std::move(start), watch, interrupt, examination);
  ProgressiveSolver solver(scene, std::move(start), interrupt, watch.preparing);
  auto saved = Clock::now();
  bool goes_on = solver.solution().record.stopped == StopReason::kUnderWay;
  while (goes_on) {
    goes_on = solver.step();
    if (watch.progress) watch.progress(solver.progress());
    if (goes_on && watch.checkpoint && seconds_since(saved) >= watch.checkpoint_s) {
      watch.checkpoint(solver.checkpoint());
      saved = Clock::now();
    }
  }
  return solver.finish(watch.progress, examination);
}

Solution solve(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
               const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  return solve(scene, new_solution(scene, std::move(mesh), settings), {.progress = progress}, interrupt);
}

Solution solve_zones(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
                     const ProgressCallback& progress, const std::atomic<bool>& interrupt) {
  return solve(scene, new_solution(scene, std::move(mesh), settings), {.progress = progress}, interrupt,
               Examination::kNone);
}

}  // namespace reemit
