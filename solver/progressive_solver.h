#pragma once
#include <atomic>
#include <functional>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "scenes/model/work_watch.h"
#include "solver/solution/solution.h"
#include "solver/solver_settings.h"

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

/// Solves the room batch by batch until a stopping rule of `settings` holds or `interrupt` becomes true; then
/// returns what stands. A batch that the time limit or `interrupt` cuts off is left out, but if it is the
/// first: then it is the solution, low by what BandAudit::unshot says, its error unknown. The time limit
/// counts from the call on. Values depend on room, mesh and settings (without threads) only, bit for bit,
/// when the run stops by error or packets. Fills everything in Solution except room_path, read_options and
/// mesh_settings. Throws InputError when a luminaire shines into a sealed part of the room that reflects
/// everything in some band: it has no solution. The matrix method has no stopping rules and nothing to return
/// when it is interrupted: it throws Interrupted, and what compute_form_factors throws. `preparing` is told
/// 0 before the tree for rays is built and 1 right before the first batch; Interrupted is thrown when it asks
/// for it there. An interrupt after the last batch cuts the examination of the solution short: what is not
/// known then is empty in SolveRecord, and Solution::light_warnings says so of lost light.
Solution solve(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
               const ProgressCallback& progress, const std::atomic<bool>& interrupt,
               const WorkWatch& preparing = {});

/// The same without what `solve` then finds out about the solution: SolveRecord::discretisation and
/// gather_bias and Solution::light_warnings stay empty. For studies that solve a small room many times, of
/// which that would be the greater part of the work.
Solution solve_zones(const Scene& scene, MeshResult mesh, const SolverSettings& settings,
                     const ProgressCallback& progress, const std::atomic<bool>& interrupt);

}  // namespace reemit
