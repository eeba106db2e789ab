#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/overlap/near_pieces.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"
#include "scenes/model/shape.h"
#include "scenes/model/work_watch.h"

namespace reemit {

/// Where faces are to be cut.
struct ContactCuts {
  /// By group: segments inside its pieces, as pairs of vertices.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> segments;
  std::vector<std::uint32_t> on_boundary;  ///< Vertices where cuts end on the boundary of a piece.
  std::size_t ignored = 0;  ///< Groups for which small contacts were ignored because there were too many.
};

/// Finds the lines along which other pieces and curved shapes stand on a group (edges within the contact
/// distance of its plane) or pierce it. However small a contact is beside a zone, it is cut: what pierces a
/// wall may be thin and long.
ContactCuts find_contact_cuts(const Scene& scene, const std::vector<FacePiece>& pieces,
                              const PieceGroups& groups, const NearPieces& near,
                              const MeshTolerances& tolerances, const WorkStep& step, VertexTable& vertices,
                              std::span<const CurvedShape> shapes = {});

}  // namespace reemit
