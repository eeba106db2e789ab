#pragma once
#include <vector>

#include "mesh/model/mesh_report.h"
#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// Area of one side of every surface [m2], by SurfaceId: what meshing has left of it, and of cut-outs what is
/// there, as far as the mesh has their solid shares. `report` and `mesh`: of the same meshing.
std::vector<double> solid_areas(const MeshReport& report, const ZoneMesh& mesh);

}  // namespace reemit
