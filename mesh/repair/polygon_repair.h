#pragma once
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_report.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Turns every face of the scene into planar pieces with welded vertices: repeated corners are merged, faces
/// without area dropped, bent polygons and polygons with varying shading normals split into triangles. Books
/// the areas as read and as removed, the counts, and warnings. Throws InputError for an outline that crosses
/// itself so that it has no front. Pre: check_faces.
std::vector<FacePiece> repair_polygons(const Scene& scene, const MeshTolerances& tolerances,
                                       VertexTable& vertices, MeshReport& report);

}  // namespace reemit
