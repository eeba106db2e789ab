#pragma once
#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A room meshed with about as many zones as `settings` asks for, whatever its number of triangles, and small
/// where light differs: build_mesh, then sides that no light reaches get one zone per surface (sealed_sides),
/// small sides share zones (plan_zones), and the cells of large ones are cut by what a quick solution says of
/// the light on them (PilotLight, refine_cells). Zones of cut-outs know what is there of them. The same for
/// any number of threads. Throws as build_mesh. Pre: finish_scene has passed the room, as all readers do.
MeshResult build_zones(const Scene& scene, const MeshSettings& settings = {}, const WorkWatch& watch = {});

}  // namespace reemit
