#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/geometry/edge_set.h"
#include "mesh/geometry/vertex_table.h"
#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Makes every vertex that lies on an edge of a piece (within `weld` metres) a corner of that piece: corners
/// of other pieces (T-junctions) and the `extra` vertices. Afterwards neighbours have the same corners along
/// common edges.
void insert_vertices_on_edges(const VertexTable& vertices, const std::vector<std::uint32_t>& extra,
                              double weld, std::vector<FacePiece>& pieces);

/// Vertices on edges, edge by edge.
struct EdgePoints {
  std::vector<std::size_t> first;       ///< By edge, and one past the last: where its vertices begin.
  std::vector<std::uint32_t> vertices;  ///< Of each edge in order from `from` to `to`.

  std::span<const std::uint32_t> on(std::size_t edge) const {
    return std::span(vertices).subspan(first[edge], first[edge + 1] - first[edge]);
  }
};

/// The places of a list that hold true, in ascending order.
std::vector<std::uint32_t> numbers_of(const std::vector<bool>& chosen);

/// For each edge the candidate vertices, each given once, that lie on it within `weld` metres (less on short
/// edges) and clear of its ends.
EdgePoints vertices_on_edges(const VertexTable& vertices, const std::vector<VertexEdge>& edges,
                             const std::vector<std::uint32_t>& candidates, double weld);

}  // namespace reemit
