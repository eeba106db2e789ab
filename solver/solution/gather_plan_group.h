#pragma once
#include "solver/solution/hdf5_group.h"
#include "solver/solution/solution.h"

namespace reemit {

// The group /gather_plan of a solution file, which solutions lack that nobody has examined:
// Solution::gather_plan.

void write_gather_plan(const Hdf5Group& root, const Solution& solution);

/// Throws Hdf5Error or FileDamage. Pre: the mesh is there.
void read_gather_plan(const Hdf5Group& root, Solution& solution);

}  // namespace reemit
