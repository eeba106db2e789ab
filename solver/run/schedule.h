#pragma once
#include <atomic>

#include "scenes/model/stop_token.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Share of all rays, and of the time, that goes to gathering on small zones at most.
inline constexpr double kSmallZoneShare = 0.15;

/// True if the run ends with gathering on zones too small for packets.
bool gathers_small_zones(const Solution& solution);

/// When the parts of a run must be over; never, without a time limit. A run that goes on begins as long
/// before now as its earlier sittings took.
struct Schedule {
  using Clock = StopToken::Clock;

  Schedule(Clock::time_point begin, const Solution& solution);

  /// Requested `seconds` after the start, or by the interrupt.
  StopToken token(double seconds, const std::atomic<bool>& interrupt) const;

  Clock::time_point start;
  double limit_s = 0;    ///< 0: no limit.
  double batches_s = 0;  ///< When the last batch must be over.
  double gather_s = 0;   ///< When gathering on small zones must be over.
};

}  // namespace reemit
