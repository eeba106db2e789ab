#pragma once
#include <cstdint>
#include <vector>

#include "mesh/face_piece.h"
#include "mesh/vertex_table.h"

namespace reemit {

/// Makes every vertex that lies on an edge of a piece (within `weld` metres) a corner of that piece: corners
/// of other pieces (T-junctions) and the `extra` vertices. Afterwards neighbours have the same corners along
/// common edges.
void insert_vertices_on_edges(const VertexTable& vertices, const std::vector<std::uint32_t>& extra,
                              double weld, std::vector<FacePiece>& pieces);

/// A straight edge between two vertices.
struct VertexEdge {
  std::uint32_t from;
  std::uint32_t to;
};

/// For each edge the candidate vertices that lie on it within `weld` metres (less on short
/// edges) and clear of its ends, in order
/// from `from` to `to`.
std::vector<std::vector<std::uint32_t>> vertices_on_edges(const VertexTable& vertices,
                                                          const std::vector<VertexEdge>& edges,
                                                          const std::vector<std::uint32_t>& candidates,
                                                          double weld);

}  // namespace reemit
