#pragma once
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/triangulate/triangulate_groups.h"

namespace reemit {

/// Splits triangles at vertices of others that lie on their edges (within `weld` metres), so that neighbours
/// share whole edges and no ray slips between them.
void conform_triangles(const VertexTable& vertices, double weld, std::vector<RawTriangle>& triangles);

}  // namespace reemit
