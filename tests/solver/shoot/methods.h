#pragma once
#include <array>

#include "solver/solution/solver_settings.h"

namespace reemit::test {

/// Both ways to follow packets.
inline constexpr std::array kMethods{SolveMethod::kShooting, SolveMethod::kWalk};

}  // namespace reemit::test
