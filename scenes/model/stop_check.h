#pragma once
#include "scenes/model/interrupted.h"
#include "scenes/model/stop_token.h"

namespace reemit {

/// For loops of work that is worth nothing in part: throws Interrupted when `stop` (may be null) is
/// requested.
inline void end_if_requested(const StopToken* stop) {
  if (stop != nullptr && stop->requested()) throw Interrupted("interrupted before there was a result");
}

}  // namespace reemit
