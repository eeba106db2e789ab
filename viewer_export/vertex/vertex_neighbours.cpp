#include "viewer_export/vertex/vertex_neighbours.h"

#include <algorithm>
#include <utility>

namespace reemit {

VertexNeighbours::VertexNeighbours(std::size_t vertices,
                                   const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(6 * triangles.size());
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      if (a == b) continue;
      edges.emplace_back(a, b);
      edges.emplace_back(b, a);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  first_.assign(vertices + 1, 0);
  neighbours_.reserve(edges.size());
  for (const auto& [from, to] : edges) {
    ++first_[from + 1];
    neighbours_.push_back(to);
  }
  for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
}

}  // namespace reemit
