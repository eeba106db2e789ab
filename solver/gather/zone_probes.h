#pragma once
#include <cstddef>
#include <vector>

#include "solver/solution/solution.h"

namespace reemit {

/// A zone to look at, and the area it stands for [m2].
struct ZoneProbe {
  ZoneId zone;
  double area = 0;
};

/// `count` zones in proportion to area times (their radiosity + the mean one), evenly along the numbering:
/// squared differences are largest where it is bright, and dark parts keep a share. `offset` [0,1): where the
/// row begins. None in a room without light.
std::vector<ZoneProbe> choose_probes(const Solution& solution, std::size_t count, double offset);

}  // namespace reemit
