#include "mesh/zones/zone_topology.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "mesh/zones/smooth_patches.h"

namespace reemit {
namespace {

OpenMesh::Vec3d to_openmesh(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// The vertices strictly inside one edge of a patch, from the corner with the smaller vertex index to the
// other. Position q of a vertex lies at the fraction q / scale of the edge.
struct EdgeVertices {
  std::uint32_t scale = 1;
  std::vector<std::uint32_t> position;
  std::uint32_t first = 0;  // their handles are consecutive
};

class TopologyBuilder {
 public:
  TopologyBuilder(const ZoneMesh& mesh, double crease_angle_deg)
      : mesh_(mesh), patches_(mesh, crease_angle_deg), edges_(6 * mesh.triangle_count()) {}

  ZoneTopology build() {
    reserve();
    add_corner_vertices();
    add_edge_vertices();
    for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) {
      const TriangleId t(i);
      add_patch(t, true);
      if (mesh_.triangle(t).two_sided) add_patch(t, false);
    }
    return std::move(out_);
  }

 private:
  // A point of the grid of a triangle: u = i/n, v = j/n.
  struct GridPoint {
    std::uint32_t i, j;
  };

  void reserve();
  void add_corner_vertices();
  void add_edge_vertices();
  void add_edge(std::size_t slot, SideId p, int k);
  void add_patch(TriangleId t, bool front);
  void add_interior_vertices();
  void add_zone(const std::array<GridPoint, 3>& corners, bool lower);
  void append_side(const GridPoint& from, const GridPoint& to, int edge);
  bool can_add() const;
  std::uint32_t vertex_at(const GridPoint& g) const;
  const EdgeVertices& edge_vertices(int k) const;
  std::uint32_t on_edge(int k, std::uint32_t steps) const;
  std::uint32_t add_vertex(const Vec3& position, const Vec3& normal);
  bool runs_down(TriangleId t, int k) const {
    const auto& v = mesh_.triangle(t).vertex;
    return v[static_cast<std::size_t>(k)] > v[static_cast<std::size_t>((k + 1) % 3)];
  }
  Vec3 corner_normal(SideId p, int k) const { return patches_.corner_normal(patches_.corner_vertex(p, k)); }

  const ZoneMesh& mesh_;
  SmoothPatches patches_;
  std::vector<EdgeVertices> edges_;  // by 3*patch+edge; of two joined slots the smaller one holds them
  ZoneTopology out_;

  // The patch at work.
  TriangleId triangle_;
  SideId patch_;
  bool front_ = true;
  std::uint32_t n_ = 1;
  std::uint32_t first_interior_ = 0;
  std::vector<OpenMesh::VertexHandle> polygon_;
};

std::uint32_t TopologyBuilder::add_vertex(const Vec3& position, const Vec3& normal) {
  const OpenMesh::VertexHandle v = out_.add_vertex(to_openmesh(position));
  const double length = normal.norm();
  out_.set_normal(v, to_openmesh(length > 0 ? Vec3(normal / length) : normal));
  return static_cast<std::uint32_t>(v.idx());
}

void TopologyBuilder::reserve() {
  std::size_t vertices = 0;
  std::size_t cells = 0;
  for (const BaseTriangle& t : mesh_.base().triangles) {
    const std::size_t n = t.divisions;
    vertices += (t.two_sided ? 2 : 1) * (n + 1) * (n + 2) / 2;
    cells += (t.two_sided ? 2 : 1) * n * n;
  }
  out_.reserve(vertices, cells + vertices, cells);
}

void TopologyBuilder::add_corner_vertices() {
  // Vertices are numbered by the first patch corner that has them, so those that are new come in ascending
  // order.
  for (std::size_t i = 0; i < mesh_.triangle_count(); ++i) {
    const TriangleId t(i);
    for (const bool front : {true, false}) {
      if (!front && !mesh_.triangle(t).two_sided) continue;
      const SideId p = side_of(t, front);
      for (int k = 0; k < 3; ++k)
        if (patches_.corner_vertex(p, k) == out_.n_vertices())
          add_vertex(mesh_.corner(t, k), corner_normal(p, k));
    }
  }
}

void TopologyBuilder::add_edge_vertices() {
  for (std::size_t slot = 0; slot < edges_.size(); ++slot) {
    const SideId p(slot / 3);
    if (!is_front(p) && !mesh_.triangle(triangle_of(p)).two_sided) continue;
    add_edge(slot, p, static_cast<int>(slot % 3));
  }
}

void TopologyBuilder::add_edge(std::size_t slot, SideId p, int k) {
  const std::uint32_t other = patches_.neighbour(p, k);
  if (other != SmoothPatches::kNone && other < slot) return;
  const TriangleId t = triangle_of(p);
  const std::uint32_t n = mesh_.triangle(t).divisions;
  const std::uint32_t m = other == SmoothPatches::kNone ? 1 : mesh_.triangle(TriangleId(other / 6)).divisions;
  EdgeVertices& edge = edges_[slot];
  edge.scale = std::lcm(n, m);
  for (std::uint32_t i = 1; i < n; ++i) edge.position.push_back(i * (edge.scale / n));
  if (m != n) {
    for (std::uint32_t i = 1; i < m; ++i) edge.position.push_back(i * (edge.scale / m));
    std::sort(edge.position.begin(), edge.position.end());
    edge.position.erase(std::unique(edge.position.begin(), edge.position.end()), edge.position.end());
  }
  edge.first = static_cast<std::uint32_t>(out_.n_vertices());
  const bool down = runs_down(t, k);
  const int from = down ? (k + 1) % 3 : k;
  const int to = down ? k : (k + 1) % 3;
  const bool curved = mesh_.triangle(t).is_curved();
  const double side = is_front(p) ? 1 : -1;
  for (const std::uint32_t q : edge.position) {
    const double s = static_cast<double>(q) / edge.scale;
    const double u = (from == 1 ? 1 - s : 0) + (to == 1 ? s : 0);
    const double v = (from == 2 ? 1 - s : 0) + (to == 2 ? s : 0);
    if (curved)
      add_vertex(mesh_.point(t, u, v), side * mesh_.normal(t, u, v));
    else
      add_vertex((1 - s) * mesh_.corner(t, from) + s * mesh_.corner(t, to),
                 (1 - s) * corner_normal(p, from) + s * corner_normal(p, to));
  }
}

const EdgeVertices& TopologyBuilder::edge_vertices(int k) const {
  const std::size_t slot = 3 * patch_.index() + static_cast<std::size_t>(k);
  const std::uint32_t other = patches_.neighbour(patch_, k);
  return edges_[other != SmoothPatches::kNone && other < slot ? other : slot];
}

// The vertex `steps` of n along edge k of the patch, strictly inside it.
std::uint32_t TopologyBuilder::on_edge(int k, std::uint32_t steps) const {
  const EdgeVertices& edge = edge_vertices(k);
  const std::uint32_t q = (runs_down(triangle_, k) ? n_ - steps : steps) * (edge.scale / n_);
  const auto found = std::lower_bound(edge.position.begin(), edge.position.end(), q);
  return edge.first + static_cast<std::uint32_t>(found - edge.position.begin());
}

std::uint32_t TopologyBuilder::vertex_at(const GridPoint& g) const {
  if (g.i == n_) return patches_.corner_vertex(patch_, 1);
  if (g.j == n_) return patches_.corner_vertex(patch_, 2);
  if (g.i == 0 && g.j == 0) return patches_.corner_vertex(patch_, 0);
  if (g.j == 0) return on_edge(0, g.i);
  if (g.i + g.j == n_) return on_edge(1, g.j);
  if (g.i == 0) return on_edge(2, n_ - g.j);
  // Row i of the interior holds n-1-i vertices.
  return first_interior_ + (g.i - 1) * (n_ - 1) - g.i * (g.i - 1) / 2 + g.j - 1;
}

void TopologyBuilder::add_interior_vertices() {
  first_interior_ = static_cast<std::uint32_t>(out_.n_vertices());
  const bool curved = mesh_.triangle(triangle_).is_curved();
  const double side = front_ ? 1 : -1;
  const std::array<Vec3, 3> normal{corner_normal(patch_, 0), corner_normal(patch_, 1),
                                   corner_normal(patch_, 2)};
  for (std::uint32_t i = 1; i + 1 < n_; ++i) {
    for (std::uint32_t j = 1; i + j < n_; ++j) {
      const double u = static_cast<double>(i) / n_;
      const double v = static_cast<double>(j) / n_;
      const Vec3 n = curved ? Vec3(side * mesh_.normal(triangle_, u, v))
                            : Vec3((1 - u - v) * normal[0] + u * normal[1] + v * normal[2]);
      add_vertex(mesh_.point(triangle_, u, v), n);
    }
  }
}

// Appends the corner `from` and what lies between it and `to`; `edge` is the edge of the patch they lie on,
// or -1.
void TopologyBuilder::append_side(const GridPoint& from, const GridPoint& to, int edge) {
  polygon_.emplace_back(static_cast<int>(vertex_at(from)));
  if (edge < 0) return;
  const EdgeVertices& finer = edge_vertices(edge);
  if (finer.scale == n_) return;
  const auto steps = [&](const GridPoint& g) { return edge == 0 ? g.i : edge == 1 ? g.j : n_ - g.j; };
  const std::uint32_t unit = finer.scale / n_;
  const bool down = runs_down(triangle_, edge);
  const std::uint32_t a = (down ? n_ - steps(from) : steps(from)) * unit;
  const std::uint32_t b = (down ? n_ - steps(to) : steps(to)) * unit;
  const auto begin = std::upper_bound(finer.position.begin(), finer.position.end(), std::min(a, b));
  const auto end = std::lower_bound(finer.position.begin(), finer.position.end(), std::max(a, b));
  const auto first = static_cast<int>(finer.first + (begin - finer.position.begin()));
  const auto count = static_cast<int>(end - begin);
  for (int i = 0; i < count; ++i) polygon_.emplace_back(first + (a < b ? i : count - 1 - i));
}

// OpenMesh's own conditions for a new face, asked beforehand because it prints when they fail.
bool TopologyBuilder::can_add() const {
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    if (!out_.is_boundary(polygon_[i])) return false;
    const OpenMesh::HalfedgeHandle h = out_.find_halfedge(polygon_[i], polygon_[(i + 1) % polygon_.size()]);
    if (h.is_valid() && !out_.is_boundary(h)) return false;
  }
  return true;
}

void TopologyBuilder::add_zone(const std::array<GridPoint, 3>& corners, bool lower) {
  polygon_.clear();
  const auto& [a, b, c] = corners;
  append_side(a, b, lower && a.j == 0 ? 0 : -1);
  append_side(b, c, lower && b.i + b.j == n_ ? 1 : -1);
  append_side(c, a, lower && a.i == 0 ? 2 : -1);
  if (!front_) std::reverse(polygon_.begin(), polygon_.end());
  OpenMesh::FaceHandle face;
  if (can_add()) face = out_.add_face(polygon_);
  if (!face.is_valid()) {  // sheets that meet in an edge or a point: this zone gets vertices of its own
    for (OpenMesh::VertexHandle& v : polygon_) {
      const OpenMesh::VertexHandle copy = out_.add_vertex(out_.point(v));
      out_.set_normal(copy, out_.normal(v));
      v = copy;
    }
    face = out_.add_face(polygon_);
  }
  const Vec3& normal = mesh_.triangle_normal(triangle_);
  out_.set_normal(face, to_openmesh(front_ ? normal : Vec3(-normal)));
}

void TopologyBuilder::add_patch(TriangleId t, bool front) {
  triangle_ = t;
  front_ = front;
  patch_ = side_of(t, front);
  n_ = mesh_.triangle(t).divisions;
  add_interior_vertices();
  // The order of zone_lookup.h.
  for (std::uint32_t i = 0; i < n_; ++i) {
    for (std::uint32_t j = 0; i + j < n_; ++j) {
      add_zone({{{i, j}, {i + 1, j}, {i, j + 1}}}, true);
      if (i + j + 1 < n_) add_zone({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}}, false);
    }
  }
}

}  // namespace

ZoneTopology make_zone_topology(const ZoneMesh& mesh, double crease_angle_deg) {
  return TopologyBuilder(mesh, crease_angle_deg).build();
}

}  // namespace reemit
