#pragma once
#include <cstdint>
#include <optional>

#include "solver/solution/solution.h"
#include "solver/solver_settings.h"

namespace reemit {

/// How far a run has come, as far as stopping is concerned.
struct RunState {
  std::int64_t batches = 0;
  std::uint64_t packets = 0;
  double error = 0;  ///< What the relative rms error stays below; infinite when not known.
  double seconds = 0;
  bool interrupted = false;
};

/// Decides how large batches are and when enough have been run. Zones that no packet can reach have no say:
/// the error is taken over power, and they have none.
class StopRule {
 public:
  StopRule(const SolverSettings& settings, std::size_t zones);

  std::uint32_t batch_packets() const { return batch_packets_; }
  /// True if this rms standard error is so low that its bound (ZoneError::bound) may have reached the target.
  bool may_reach_target(std::int64_t batches, double rms_error) const;
  /// The reason to stop now, or nothing. An error is believed only after settings.smallest_batch_count
  /// batches.
  std::optional<StopReason> stop(const RunState& state) const;
  /// Estimate of how much of the run is done [0,1], by the rule that will end it first.
  double fraction_done(const RunState& state) const;

 private:
  SolverSettings settings_;
  std::uint32_t batch_packets_ = 0;
  std::int64_t batches_for_packets_ = 0;  // 0 = no packet limit
};

}  // namespace reemit
