#include "mesh/edge_points.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "mesh/box_tree.h"
#include "mesh/convex_region.h"

namespace reemit {

EdgePoints vertices_on_edges(const VertexTable& vertices, const std::vector<VertexEdge>& edges,
                             const std::vector<std::uint32_t>& candidates, double weld) {
  std::vector<IndexedBox> points;
  points.reserve(candidates.size());
  for (const std::uint32_t v : candidates) points.push_back({vertices[v], vertices[v], v});
  const BoxTree tree(std::move(points));

  EdgePoints out;
  out.first.reserve(edges.size() + 1);
  out.first.push_back(0);
  std::vector<std::pair<double, std::uint32_t>> found;
  for (const VertexEdge& edge : edges) {
    const Vec3& from = vertices[edge.from];
    const Vec3 along = vertices[edge.to] - from;
    const double length = along.norm();
    const auto region = ConvexRegion::of_edge(from, vertices[edge.to], weld);
    found.clear();
    tree.visit([&](const Vec3& low, const Vec3& high) { return region.touches(low, high); },
               [&](std::uint32_t v) {
                 if (v == edge.from || v == edge.to) return;
                 const Vec3 offset = vertices[v] - from;
                 const double t = offset.dot(along) / (length * length);
                 if (t * length <= weld || (1 - t) * length <= weld) return;
                 // Short edges would be bent visibly by the weld distance, and the area of their face
                 // changed.
                 constexpr double kMostBend = 1e-4;
                 if ((offset - t * along).norm() > std::min(weld, kMostBend * length)) return;
                 found.emplace_back(t, v);
               });
    std::sort(found.begin(), found.end());
    for (const auto& [t, v] : found) out.vertices.push_back(v);
    out.first.push_back(out.vertices.size());
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
  const EdgePoints inserted = vertices_on_edges(vertices, edges, candidates, weld);

  for (FacePiece& piece : pieces) {
    for (Loop& loop : piece.loops) {
      Loop longer;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i];
        const std::uint32_t b = loop[(i + 1) % loop.size()];
        const auto between = inserted.on(edge_index.at(key(a, b)));
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
