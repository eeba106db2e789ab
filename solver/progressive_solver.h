#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "scenes/model/work_watch.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "solver/solution/solver_settings.h"

namespace reemit {

struct SolveProgress {
  double fraction = 0;  ///< Of the work until the stopping rule holds, an estimate [0,1].
  double error = 0;     ///< Relative rms standard error so far (ZoneError::rms); infinite before two batches.
  double error_bound = 0;   ///< ZoneError::bound when it was last looked at, infinite where it was not yet.
  double unshot_share = 0;  ///< Power on its way when batches ended, over emitted power, worst band.
  double rays_per_second = 0;
  double seconds = 0;
  double seconds_left = 0;  ///< Infinite when not known yet.
  std::uint64_t rays = 0;
  std::uint64_t packets = 0;
  std::int64_t batches = 0;
  bool examines =
      false;  ///< The last batch is done: how good the solution is and where light is lost comes next.
};
using ProgressCallback = std::function<void(const SolveProgress&)>;

/// What is found out about a solution once its last batch is in.
enum class Examination {
  kWhole,
  /// SolveRecord::discretisation and gather_bias and Solution::light_warnings stay empty: for studies that
  /// solve a small room many times, of which they would be the greater part of the work.
  kNone,
};

/// A solution of this room without any batch: where a run starts. Everything in it is filled but what only
/// the caller knows: more_room_paths, read_options and mesh_settings where they are not the defaults, and
/// room_path where the room was not read from Scene::source. Throws InputError for settings out of range.
Solution new_solution(const Scene& scene, MeshResult mesh, const SolverSettings& settings);

/// A run by shooting or walks, batch by batch, that can be looked at and saved between batches and resumed
/// later. Values depend on room, mesh and settings (without threads) only, bit for bit, however often the run
/// was resumed, when it stops by error or packets.
class ProgressiveSolver {
 public:
  /// Goes on from `start`: a new_solution, one that a checkpoint saved, or a finished one, whose settings may
  /// have other stopping rules and threads than before; with others changed the batches would not go
  /// together. A time limit is that of all sittings together: SolveRecord::seconds
  /// are gone already. A batch that it or `interrupt` cuts off is left out, but if
  /// it is the first: then it is the solution, low by what BandAudit::unshot says, its error unknown.
  /// `preparing` is told 0 before the tree for rays is built and 1 at the end. Throws InputError when a
  /// luminaire shines into a sealed part of the room that reflects everything in some band: it has no
  /// solution; for settings out of range, and when `start` is of another room. The scene and `interrupt` must
  /// outlive the solver. Pre: the method is not the matrix.
  ProgressiveSolver(const Scene& scene, Solution start, const std::atomic<bool>& interrupt,
                    const WorkWatch& preparing = {});
  ProgressiveSolver(const Scene&&, Solution, const std::atomic<bool>&, const WorkWatch& = {}) = delete;
  ProgressiveSolver(const Scene&, Solution, std::atomic<bool>&&, const WorkWatch& = {}) = delete;
  ~ProgressiveSolver();
  ProgressiveSolver(const ProgressiveSolver&) = delete;
  ProgressiveSolver& operator=(const ProgressiveSolver&) = delete;

  /// Adds a batch; false, without a further one, once a stopping rule holds or `interrupt` is true. Other
  /// batches go on meanwhile, on other threads.
  bool step();
  SolveProgress progress() const;
  /// What stands. SolveRecord::stopped is kUnderWay until a rule holds.
  const Solution& solution() const;
  /// The same with all that the record says about its noise, ready to be saved.
  const Solution& checkpoint();
  /// Ends the run, with light on zones too small for packets. An interrupt cuts the examination short: what
  /// is not known then is empty in SolveRecord, and Solution::light_warnings says so of lost light. Does
  /// nothing the second time.
  void end(const ProgressCallback& progress = {}, Examination examination = Examination::kWhole);
  /// The same, and hands over the solution. As the last call.
  Solution finish(const ProgressCallback& progress = {}, Examination examination = Examination::kWhole);
  /// The room as rays meet it, with the zones of the solution.
  const Room& room() const;

 private:
  class Run;
  std::unique_ptr<Run> run_;
};

/// The stopping rule of its settings that a solution meets already, so that a run would add no batch to it;
/// nothing if it would.
std::optional<StopReason> rule_that_holds(const Scene& scene, const Solution& solution);

/// Who watches a solve.
struct SolveWatch {
  ProgressCallback progress = {};
  WorkWatch preparing = {};
  /// Is given what stands, at intervals, between two batches; not by the matrix method.
  std::function<void(const Solution&)> checkpoint = {};
  double checkpoint_s = 600;  ///< Wall time between two checkpoints [s].
};

/// Runs a ProgressiveSolver from `start` to its end. The matrix method has no stopping rules and nothing to
/// return when it is interrupted: it throws Interrupted, and what compute_form_factors throws.
Solution solve(const Scene& scene, Solution start, const SolveWatch& watch,
               const std::atomic<bool>& interrupt, Examination examination = Examination::kWhole);

/// The same from the beginning.
Solution solve(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
               const ProgressCallback& progress, const std::atomic<bool>& interrupt);
/// The same with Examination::kNone.
Solution solve_zones(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
                     const ProgressCallback& progress, const std::atomic<bool>& interrupt);

}  // namespace reemit
