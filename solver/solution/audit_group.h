#pragma once
#include "solver/solution/hdf5_group.h"
#include "solver/solution/solution.h"

namespace reemit {

// The group /audit of a solution file: Solution::audit and Solution::light_warnings.

/// Throws Hdf5Error.
void write_audit(const Hdf5Group& root, const Solution& solution);

/// Throws Hdf5Error or FileDamage. Pre: the number of channels and the surfaces are there already.
void read_audit(const Hdf5Group& root, Solution& solution);

}  // namespace reemit
