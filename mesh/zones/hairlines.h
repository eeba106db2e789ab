#pragma once
#include "mesh/zones/base_mesh.h"

namespace reemit {

/// Whether rays may slip through the mesh where it should be closed: along an edge of one flat triangle that
/// lies against another triangle without having the places of both vertices in common with it, or where round
/// shapes touch flat faces. Where both ends of an edge are the same numbers no ray passes between. Meshes too
/// large to be looked through edge by edge count as having hairlines.
bool may_have_hairlines(const BaseMesh& mesh);

}  // namespace reemit
