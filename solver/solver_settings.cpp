#include "solver/solver_settings.h"

namespace reemit {

std::string to_string(SolveMethod method) {
  return method == SolveMethod::kShooting ? "shooting" : "walk";
}

std::string to_string(SamplingKind sampling) {
  return sampling == SamplingKind::kSobol ? "sobol" : "random";
}

}  // namespace reemit
