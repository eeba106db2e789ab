#include "mesh/pieces/edge_points.h"

#include <algorithm>
#include <utility>

#include <tbb/parallel_for.h>

#include "mesh/geometry/box_tree.h"
#include "mesh/pieces/convex_region.h"

namespace reemit {

namespace {

constexpr std::size_t kEdgesTogether = 1024;

/// Appends the vertices on an edge, in order.
void add_vertices_on(const VertexEdge& edge, const VertexTable& vertices, const BoxTree& tree, double weld,
                     std::vector<std::uint32_t>& out) {
  const Vec3& from = vertices[edge.from];
  const Vec3 along = vertices[edge.to] - from;
  const double length = along.norm();
  const auto region = ConvexRegion::of_edge(from, vertices[edge.to], weld);
  const Vec3 edge_low = from.cwiseMin(vertices[edge.to]).array() - weld;
  const Vec3 edge_high = from.cwiseMax(vertices[edge.to]).array() + weld;
  // Beside the box around the edge, the region only tells boxes apart that are smaller than the edge, and
  // single points are looked at below.
  const auto admit = [&](const Vec3& low, const Vec3& high) {
    if ((low.array() > edge_high.array()).any() || (high.array() < edge_low.array()).any()) return false;
    const double size = (high - low).maxCoeff();
    return size == 0 || size >= length || region.touches(low, high);
  };
  std::vector<std::pair<double, std::uint32_t>> found;
  tree.visit(admit, [&](std::uint32_t v) {
    if (v == edge.from || v == edge.to) return;
    const Vec3 offset = vertices[v] - from;
    const double t = offset.dot(along) / (length * length);
    if (t * length <= weld || (1 - t) * length <= weld) return;
    // Short edges would be bent visibly by the weld distance, and the area of their face changed.
    constexpr double kMostBend = 1e-4;
    if ((offset - t * along).norm() > std::min(weld, kMostBend * length)) return;
    found.emplace_back(t, v);
  });
  std::sort(found.begin(), found.end());
  for (const auto& [t, v] : found) out.push_back(v);
}

}  // namespace

EdgePoints vertices_on_edges(const VertexTable& vertices, const std::vector<VertexEdge>& edges,
                             const std::vector<std::uint32_t>& candidates, double weld) {
  std::vector<IndexedBox> points;
  points.reserve(candidates.size());
  for (const std::uint32_t v : candidates) points.push_back({vertices[v], vertices[v], v});
  const BoxTree tree(std::move(points));

  const std::size_t blocks = (edges.size() + kEdgesTogether - 1) / kEdgesTogether;
  std::vector<EdgePoints> of_block(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t begin = block * kEdgesTogether;
    const std::size_t end = std::min(edges.size(), begin + kEdgesTogether);
    for (std::size_t e = begin; e < end; ++e) {
      add_vertices_on(edges[e], vertices, tree, weld, of_block[block].vertices);
      of_block[block].first.push_back(of_block[block].vertices.size());
    }
  });
  EdgePoints out;
  out.first.reserve(edges.size() + 1);
  out.first.push_back(0);
  for (const EdgePoints& block : of_block) {
    const std::size_t before = out.vertices.size();
    for (const std::size_t behind : block.first) out.first.push_back(before + behind);
    out.vertices.insert(out.vertices.end(), block.vertices.begin(), block.vertices.end());
  }
  return out;
}

std::vector<std::uint32_t> numbers_of(const std::vector<bool>& chosen) {
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) numbers.push_back(static_cast<std::uint32_t>(i));
  return numbers;
}

void insert_vertices_on_edges(const VertexTable& vertices, const std::vector<std::uint32_t>& extra,
                              double weld, std::vector<FacePiece>& pieces) {
  const EdgeSet edges(vertices.size(), [&](const auto& visit) {
    for (const FacePiece& piece : pieces)
      for (const Loop& loop : piece.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
  });
  std::vector<bool> is_candidate(vertices.size(), false);
  for (const std::uint32_t v : extra) is_candidate[v] = true;
  for (const FacePiece& piece : pieces)
    for (const Loop& loop : piece.loops)
      for (const std::uint32_t v : loop) is_candidate[v] = true;
  const EdgePoints inserted = vertices_on_edges(vertices, edges.edges(), numbers_of(is_candidate), weld);

  for (FacePiece& piece : pieces) {
    for (Loop& loop : piece.loops) {
      Loop longer;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i];
        const std::uint32_t b = loop[(i + 1) % loop.size()];
        const auto between = inserted.on(edges.index(a, b));
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
