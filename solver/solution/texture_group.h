#pragma once
#include "solver/solution/hdf5_group.h"
#include "solver/solution/solution.h"

namespace reemit {

// The group /textures of a solution file, which rooms without textures lack: Solution::zone_reflectances and
// zone_exitances, and the solid shares of the mesh.

void write_textures(const Hdf5Group& root, const Solution& solution);

/// Throws Hdf5Error, FileDamage, or what ZoneMesh::set_solid_shares throws. Pre: mesh and bands are there.
void read_textures(const Hdf5Group& root, Solution& solution);

}  // namespace reemit
