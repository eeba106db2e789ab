#pragma once

namespace reemit::cli {

/// Exit codes of the program; scripts rely on them.
enum class ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,    ///< The books do not balance, or `audit --direct` found a difference.
  kBadInput = 2,       ///< Bad usage, bad input, or an output that cannot be written.
  kNoResources = 3,    ///< Out of memory.
  kInterrupted = 130,  ///< A signal came before there was a result.
};

}  // namespace reemit::cli
