#pragma once
#include <cstdint>
#include <optional>

#include "solver/solution/solution.h"
#include "solver/solution/solver_settings.h"
#include "solver/tally/batch_plan.h"

namespace reemit {

/// How far a run has come, as far as stopping is concerned.
struct RunState {
  std::int64_t batches = 0;
  std::int64_t weight = 0;   ///< Of all batches (BatchPlan).
  double error = 0;          ///< What the relative rms error stays below; infinite when not known.
  double unshot_share = 0;   ///< Power on its way when batches ended, over emitted power, worst band.
  double seconds = 0;        ///< Since the start of the run.
  double batch_seconds = 0;  ///< For each unit of weight, as the last batch showed; 0 when there was none.
  bool shortened = false;    ///< The last batch was smaller than planned, to end in time.
};

/// Decides how large the next batch is and when enough have been run. Zones that no packet can reach have no
/// say: the error is taken over power, and they have none. Without a time limit its answers depend on the
/// settings, the number of zones and the state but for the time.
class StopRule {
 public:
  /// Batches have settings.time_limit_s less what the caller keeps for work after them.
  StopRule(const SolverSettings& settings, const BatchPlan& plan, double batch_time_s);

  /// True if this rms standard error is so low that its bound (ZoneError::bound) may have reached the target.
  bool may_reach_target(std::int64_t batches, double rms_error) const;
  /// Weight of the next batch: that of the plan, or what fits into the time left. The first two are run in
  /// any case.
  std::int64_t next_weight(const RunState& state) const;
  /// The reason to stop instead of running another batch, or nothing. An error is believed only after
  /// settings.smallest_batch_count batches.
  std::optional<StopReason> stop(const RunState& state) const;
  /// Estimate of how much of the run is done [0,1], by the rule that will end it first.
  double fraction_done(const RunState& state) const;

 private:
  SolverSettings settings_;
  BatchPlan plan_;
  double batch_time_s_;
};

}  // namespace reemit
