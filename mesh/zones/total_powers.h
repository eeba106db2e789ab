#pragma once
#include "mesh/model/mesh_report.h"
#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Gives materials whose emission is a total power the radiance at which their surfaces send it: the power
/// that a reader spread over all of them goes to what meshing has left, where lamps stand on things, overlap
/// or are twice in one place, and of cut-outs to what is there (solid_areas). Those of which nothing is left
/// stay as they are. Does nothing when it is done again. `report` and `mesh`: of meshing this scene.
void spread_total_powers(const MeshReport& report, const ZoneMesh& mesh, Scene& scene);

}  // namespace reemit
