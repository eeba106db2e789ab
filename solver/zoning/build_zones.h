#pragma once
#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A room meshed with about as many zones as `settings` asks for, whatever its number of triangles:
/// build_mesh, then sides that no light reaches get one zone per surface (sealed_sides), the rest is sized
/// anew by the area that is left, and small sides share zones (group_sides). Throws as build_mesh.
MeshResult build_zones(const Scene& scene, const MeshSettings& settings = {}, const WorkWatch& watch = {});

}  // namespace reemit
