#include "solver/tally/stop_rule.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

/// Smallest batch by default: large enough that starting one costs little beside its rays.
constexpr std::uint64_t kSmallestBatch = 65536;
/// Packets per zone in a batch by default. Each sweep looks at all zones with power: fewer packets make that
/// the larger part of the work. Eight such batches leave a relative error of about 8 %.
constexpr std::uint64_t kPacketsPerZone = 16;
/// Batches whose sums still fit into 63 bits of quanta (kBatchQuanta = 2^42).
constexpr std::int64_t kMostBatches = std::int64_t{1} << 20;

}  // namespace

StopRule::StopRule(const SolverSettings& settings, std::size_t zones) : settings_(settings) {
  std::uint64_t per_batch = settings.batch_packets > 0
                                ? settings.batch_packets
                                : std::max<std::uint64_t>(kSmallestBatch, kPacketsPerZone * zones);
  const auto least = static_cast<std::uint64_t>(std::max(2, settings.smallest_batch_count));
  if (settings.packets > 0) {
    const std::uint64_t batches = std::max(settings.batch_packets > 0 ? std::uint64_t{1} : least,
                                           (settings.packets + per_batch - 1) / per_batch);
    if (settings.batch_packets == 0) per_batch = std::max<std::uint64_t>(1, settings.packets / batches);
    batches_for_packets_ =
        static_cast<std::int64_t>(std::max<std::uint64_t>(1, settings.packets / per_batch));
  }
  batch_packets_ =
      static_cast<std::uint32_t>(std::clamp<std::uint64_t>(per_batch, 1, std::uint64_t{1} << 31));
}

bool StopRule::may_reach_target(std::int64_t batches, double rms_error) const {
  return settings_.error_target > 0 && batches >= settings_.smallest_batch_count &&
         rms_error <= settings_.error_target;
}

std::optional<StopReason> StopRule::stop(const RunState& state) const {
  if (state.interrupted) return StopReason::kInterrupted;
  if (settings_.error_target > 0 && state.batches >= settings_.smallest_batch_count &&
      state.error <= settings_.error_target)
    return StopReason::kErrorTarget;
  if (batches_for_packets_ > 0 && state.batches >= batches_for_packets_) return StopReason::kPacketCount;
  // Another batch would end beyond the limit: stop on this side of it.
  const double batch_seconds = state.batches > 0 ? state.seconds / static_cast<double>(state.batches) : 0.0;
  if (settings_.time_limit_s > 0 && state.batches >= 2 &&
      state.seconds + 0.5 * batch_seconds >= settings_.time_limit_s)
    return StopReason::kTimeLimit;
  if (state.batches >= kMostBatches) return StopReason::kBatchLimit;
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
  if (batches_for_packets_ > 0)
    done = std::max(done, static_cast<double>(state.batches) / static_cast<double>(batches_for_packets_));
  if (settings_.time_limit_s > 0) done = std::max(done, state.seconds / settings_.time_limit_s);
  return std::min(1.0, done);
}

}  // namespace reemit
