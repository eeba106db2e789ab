#pragma once
#include "mesh/model/mesh_report.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Looks for luminaires that repair left out because they are too small or too thin for the room
/// (SurfaceAreas::collapsed). Some of the power: adds a warning with the share that is lost. All of it, in a
/// room that nothing else lights: throws InputError that names the luminaire.
void check_dropped_luminaires(const Scene& scene, double weld, MeshReport& report);

}  // namespace reemit
