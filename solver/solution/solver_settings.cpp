#include "solver/solution/solver_settings.h"

#include <cmath>

#include "scenes/model/error.h"

namespace reemit {

void check(const SolverSettings& s) {
  const auto require = [](bool good, const char* name, const char* range) {
    if (!good)
      throw InputError("solve", std::string(name) + " is out of range", std::string("Choose ") + range);
  };
  require(s.error_target >= 0 && s.error_target < 1, "error", "a share below 1, such as 2%.");
  require(s.time_limit_s >= 0 && std::isfinite(s.time_limit_s), "time limit", "seconds, 0 for none.");
  require(s.batch_packets <= kMostBatchPackets, "packets of a batch",
          "at most 2^31, 0 for as many as suit the number of zones.");
  require(s.smallest_batch_count >= 2 && s.smallest_batch_count <= 65536, "smallest number of batches",
          "2 to 65536.");
  require(s.stop_share > 0 && s.stop_share <= 0.1, "share at which walks take over",
          "more than 0 and at most 0.1.");
  require(s.threads >= 0, "number of threads", "0 (all cores) or more.");
}

std::string to_string(SolveMethod method) {
  switch (method) {
    case SolveMethod::kShooting:
      return "shooting";
    case SolveMethod::kWalk:
      return "walk";
    case SolveMethod::kMatrix:
      return "matrix";
  }
  return "unknown";
}

std::string to_string(SamplingKind sampling) {
  return sampling == SamplingKind::kSobol ? "sobol" : "random";
}

std::string to_string(Reemission reemission) {
  return reemission == Reemission::kFromHits ? "hits" : "zones";
}

std::string to_string(DirectSource direct) {
  return direct == DirectSource::kBest ? "best" : "packets";
}

}  // namespace reemit
