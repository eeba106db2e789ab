#pragma once
#include <cstdint>
#include <vector>

#include "mesh/contact/contact_split.h"
#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_report.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/pieces/face_piece.h"
#include "mesh/pieces/planar_triangulation.h"
#include "scenes/model/work_watch.h"

namespace reemit {

/// A base triangle before its vertices and normals are numbered for the mesh.
struct RawTriangle {
  std::array<std::uint32_t, 3> vertex;  ///< Into the VertexTable, counter-clockwise from the front.
  std::size_t piece;                    ///< It was cut from.
  std::size_t back = Keepers::kNobody;  ///< The piece that its back shows, if that is another.
};

struct GroupTriangles {
  std::vector<RawTriangle> triangles;
  std::vector<double> covered;  ///< By piece: area that went to other pieces of its plane [m2].
};

/// Triangulates every group with its cuts. Where pieces overlap, one keeps the spot, or two back to back, and
/// the others lose it; a warning says how much. Throws InputError naming the face if its area could not be
/// preserved.
GroupTriangles triangulate_groups(const Scene& scene, const std::vector<FacePiece>& pieces,
                                  const PieceGroups& groups, const ContactCuts& cuts,
                                  const MeshTolerances& tolerances, const TriangleQuality& quality,
                                  const WorkStep& step, VertexTable& vertices, MeshReport& report);

}  // namespace reemit
