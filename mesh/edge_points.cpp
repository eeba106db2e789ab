#include "mesh/edge_points.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "mesh/box_pairs.h"

namespace reemit {

std::vector<std::vector<std::uint32_t>> vertices_on_edges(const VertexTable& vertices,
                                                          const std::vector<VertexEdge>& edges,
                                                          const std::vector<std::uint32_t>& candidates,
                                                          double weld) {
  std::vector<IndexedBox> edge_boxes;
  edge_boxes.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec3& a = vertices[edges[i].from];
    const Vec3& b = vertices[edges[i].to];
    const Vec3 margin = Vec3::Constant(weld);
    edge_boxes.push_back({a.cwiseMin(b) - margin, a.cwiseMax(b) + margin, static_cast<std::uint32_t>(i)});
  }
  std::vector<IndexedBox> point_boxes;
  point_boxes.reserve(candidates.size());
  for (const std::uint32_t v : candidates) point_boxes.push_back({vertices[v], vertices[v], v});

  std::vector<std::vector<std::pair<double, std::uint32_t>>> found(edges.size());
  for_each_box_pair(edge_boxes, point_boxes, [&](std::uint32_t e, std::uint32_t v) {
    const VertexEdge& edge = edges[e];
    if (v == edge.from || v == edge.to) return;
    const Vec3 along = vertices[edge.to] - vertices[edge.from];
    const Vec3 offset = vertices[v] - vertices[edge.from];
    const double length = along.norm();
    const double t = offset.dot(along) / (length * length);
    if (t * length <= weld || (1 - t) * length <= weld) return;
    // Short edges would be bent visibly by the weld distance, and the area of their face changed.
    constexpr double kMostBend = 1e-4;
    if ((offset - t * along).norm() > std::min(weld, kMostBend * length)) return;
    found[e].emplace_back(t, v);
  });
  std::vector<std::vector<std::uint32_t>> out(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::sort(found[e].begin(), found[e].end());
    for (const auto& [t, v] : found[e])
      if (out[e].empty() || out[e].back() != v) out[e].push_back(v);
  }
  return out;
}

void insert_vertices_on_edges(const VertexTable& vertices, const std::vector<std::uint32_t>& extra,
                              double weld, std::vector<FacePiece>& pieces) {
  std::vector<VertexEdge> edges;
  std::unordered_map<std::uint64_t, std::size_t> edge_index;
  std::vector<std::uint32_t> candidates(extra);
  const auto key = [](std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
  };
  for (const FacePiece& piece : pieces) {
    for (const Loop& loop : piece.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto [a, b] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
        if (edge_index.try_emplace(key(a, b), edges.size()).second) edges.push_back({a, b});
        candidates.push_back(loop[i]);
      }
    }
  }
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  const auto inserted = vertices_on_edges(vertices, edges, candidates, weld);

  for (FacePiece& piece : pieces) {
    for (Loop& loop : piece.loops) {
      Loop longer;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i];
        const std::uint32_t b = loop[(i + 1) % loop.size()];
        const auto& between = inserted[edge_index.at(key(a, b))];
        longer.push_back(a);
        if (a < b)
          longer.insert(longer.end(), between.begin(), between.end());
        else
          longer.insert(longer.end(), between.rbegin(), between.rend());
      }
      loop = std::move(longer);
    }
  }
}

}  // namespace reemit
