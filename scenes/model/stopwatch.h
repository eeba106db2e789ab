#pragma once
#include <algorithm>
#include <chrono>

#include "scenes/model/stop_token.h"

namespace reemit {

/// Beyond what a clock can count it is as good as for ever.
inline StopToken::Clock::duration clock_duration(double seconds) {
  constexpr double kLongest = 1e9;
  const std::chrono::duration<double> span(std::min(seconds, kLongest));
  return std::chrono::duration_cast<StopToken::Clock::duration>(span);
}

/// Wall time since then [s].
inline double seconds_since(StopToken::Clock::time_point start) {
  return std::chrono::duration<double>(StopToken::Clock::now() - start).count();
}

/// The moment so long before now [s].
inline StopToken::Clock::time_point seconds_ago(double seconds) {
  return StopToken::Clock::now() - clock_duration(seconds);
}

}  // namespace reemit
