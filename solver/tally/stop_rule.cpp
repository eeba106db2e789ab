#include "solver/tally/stop_rule.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

/// Batches from which on there is an error to state; until then the time limit waits for its deadline.
constexpr std::int64_t kFewestBatches = 2;

}  // namespace

StopRule::StopRule(const SolverSettings& settings, const BatchPlan& plan, double batch_time_s)
    : settings_(settings), plan_(plan), batch_time_s_(batch_time_s) {}

bool StopRule::may_reach_target(std::int64_t batches, double rms_error) const {
  return settings_.error_target > 0 && batches >= settings_.smallest_batch_count &&
         rms_error <= settings_.error_target;
}

std::int64_t StopRule::next_weight(const RunState& state) const {
  const std::int64_t planned = plan_.next_weight(state.batches, state.weight);
  if (!(settings_.time_limit_s > 0) || state.batches < kFewestBatches || !(state.batch_seconds > 0))
    return planned;
  const double fits = std::floor((batch_time_s_ - state.seconds) / state.batch_seconds);
  return fits < static_cast<double>(planned) ? static_cast<std::int64_t>(std::max(0.0, fits)) : planned;
}

std::optional<StopReason> StopRule::stop(const RunState& state) const {
  // Whatever a shortened batch has brought about, the clock had a hand in it.
  if (state.shortened) return StopReason::kTimeLimit;
  if (settings_.error_target > 0 && state.batches >= settings_.smallest_batch_count &&
      state.error <= settings_.error_target)
    return state.unshot_share <= settings_.error_target ? StopReason::kErrorTarget : StopReason::kBounceLimit;
  if (plan_.next_weight(state.batches, state.weight) == 0)
    return plan_.weight_of_packets() > 0 && state.weight >= plan_.weight_of_packets()
               ? StopReason::kPacketCount
               : StopReason::kBatchLimit;
  if (next_weight(state) == 0) return StopReason::kTimeLimit;
  return std::nullopt;
}

double StopRule::fraction_done(const RunState& state) const {
  double done = 0;
  if (settings_.error_target > 0 && std::isfinite(state.error) && state.error > 0) {
    // Noise falls with the square root of the work.
    const double by_error = std::pow(settings_.error_target / state.error, 2);
    const double by_batches = static_cast<double>(state.batches) / settings_.smallest_batch_count;
    done = std::max(done, std::min(by_error, by_batches));
  }
  if (plan_.weight_of_packets() > 0)
    done = std::max(done, static_cast<double>(state.weight) / static_cast<double>(plan_.weight_of_packets()));
  if (settings_.time_limit_s > 0) done = std::max(done, state.seconds / settings_.time_limit_s);
  return std::min(1.0, done);
}

}  // namespace reemit
