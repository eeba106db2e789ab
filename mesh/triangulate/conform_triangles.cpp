#include "mesh/triangulate/conform_triangles.h"

#include <algorithm>

#include "mesh/pieces/edge_points.h"

namespace reemit {
namespace {

// A triangle with vertices on its sides; side k runs from corner k to corner k+1.
struct Studded {
  std::array<std::uint32_t, 3> corner;
  std::array<std::vector<std::uint32_t>, 3> on_side;
};

// Cuts from the middle vertex of the most crowded side to the corner opposite, until no vertices are left.
void split(const Studded& s, const RawTriangle& whole, std::vector<RawTriangle>& out) {
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (s.on_side[i].size() > s.on_side[k].size()) k = i;
  const std::vector<std::uint32_t>& side = s.on_side[k];
  if (side.empty()) {
    out.push_back({s.corner, whole.piece, whole.back});
    return;
  }
  const auto middle = static_cast<std::ptrdiff_t>(side.size() / 2);
  const std::uint32_t m = side[static_cast<std::size_t>(middle)];
  const std::uint32_t a = s.corner[k];
  const std::uint32_t b = s.corner[(k + 1) % 3];
  const std::uint32_t c = s.corner[(k + 2) % 3];
  split({{a, m, c},
         {std::vector<std::uint32_t>(side.begin(), side.begin() + middle), {}, s.on_side[(k + 2) % 3]}},
        whole, out);
  split({{m, b, c},
         {std::vector<std::uint32_t>(side.begin() + middle + 1, side.end()), s.on_side[(k + 1) % 3], {}}},
        whole, out);
}

}  // namespace

void conform_triangles(const VertexTable& vertices, double weld, std::vector<RawTriangle>& triangles) {
  const EdgeSet edges(vertices.size(), [&](const auto& visit) {
    for (const RawTriangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) visit(t.vertex[k], t.vertex[(k + 1) % 3]);
  });
  std::vector<bool> is_end(vertices.size(), false);
  for (const RawTriangle& t : triangles)
    for (const std::uint32_t v : t.vertex) is_end[v] = true;
  const EdgePoints between = vertices_on_edges(vertices, edges.edges(), numbers_of(is_end), weld);

  std::vector<RawTriangle> out;
  out.reserve(triangles.size());
  for (const RawTriangle& t : triangles) {
    Studded studded{t.vertex, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t.vertex[k];
      const std::uint32_t b = t.vertex[(k + 1) % 3];
      const auto on_side = between.on(edges.index(a, b));
      studded.on_side[k].assign(on_side.begin(), on_side.end());
      if (a > b) std::reverse(studded.on_side[k].begin(), studded.on_side[k].end());
      std::erase(studded.on_side[k], t.vertex[(k + 2) % 3]);  // of a needle lower than the weld distance
    }
    split(studded, t, out);
  }
  triangles = std::move(out);
}

}  // namespace reemit
