#include "solver/solution/solver_settings.h"

namespace reemit {

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
