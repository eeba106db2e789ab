#include "mesh/zones/zone_topology.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

#include "mesh/zones/grid_points.h"
#include "mesh/zones/smooth_patches.h"
#include "mesh/zones/zone_cells.h"

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

/// The corners of a cell on a grid that is finer than its own, or that.
std::array<GridPoint, 3> corners_of(const SideCell& cell, std::uint32_t divisions) {
  std::array<GridPoint, 3> corners = cell.corners.at;
  for (GridPoint& g : corners) g = on_finer_grid(g, divisions / cell.corners.divisions);
  return corners;
}

class TopologyBuilder {
 public:
  TopologyBuilder(const ZoneMesh& mesh, double crease_angle_deg)
      : mesh_(mesh), cells_(mesh), patches_(mesh, crease_angle_deg), edges_(3 * mesh.side_count()) {
    for (const SideId side : mesh.splits().sides) split_[side] = points_of(side);
  }

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
  // A side with cells of several sizes.
  struct SplitSide {
    std::uint32_t divisions = 1;    // of the finest grid
    std::vector<GridPoint> points;  // of it: corners of its cells, ascending
  };

  SplitSide points_of(SideId side) const;
  const SplitSide* split_side(SideId side) const {
    const auto found = split_.find(side);
    return found == split_.end() ? nullptr : &found->second;
  }
  std::uint32_t finest_divisions(SideId side) const {
    const SplitSide* split = split_side(side);
    return split != nullptr ? split->divisions : mesh_.triangle(triangle_of(side)).divisions;
  }
  std::vector<std::uint32_t> steps_on_edge(SideId side, int k) const;

  void reserve();
  void add_corner_vertices();
  void add_edge_vertices();
  void add_edge(std::size_t slot, SideId p, int k);
  void add_patch(TriangleId t, bool front);
  void add_interior_vertices();
  void add_interior_vertex(const GridPoint& g);
  void add_cell(const SideCell& cell);
  int edge_of(const GridPoint& a, const GridPoint& b) const;
  void append_side(const GridPoint& from, const GridPoint& to);
  void append_between(const GridPoint& from, const GridPoint& to);
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
  ZoneCells cells_;
  SmoothPatches patches_;
  std::map<SideId, SplitSide> split_;
  std::vector<EdgeVertices> edges_;  // by 3*patch+edge; of two joined slots the smaller one holds them
  ZoneTopology out_;

  // The patch at work.
  TriangleId triangle_;
  SideId patch_;
  bool front_ = true;
  std::uint32_t n_ = 1;                   // of its finest grid
  const SplitSide* split_now_ = nullptr;  // its cells if they are not all of that grid
  std::vector<GridPoint> interior_;       // their corners inside the patch
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
  for (const BaseTriangle& t : mesh_.base().triangles) {
    const std::size_t n = t.divisions;
    vertices += (t.two_sided ? 2 : 1) * (n + 1) * (n + 2) / 2;
  }
  for (const auto& [side, split] : split_) vertices += split.points.size();
  out_.reserve(vertices, cells_.size() + vertices, cells_.size());
}

TopologyBuilder::SplitSide TopologyBuilder::points_of(SideId side) const {
  SplitSide split;
  const std::size_t first = cells_.first(side);
  const std::size_t last = cells_.first(SideId(side.index() + 1));
  for (std::size_t c = first; c < last; ++c)
    split.divisions = std::max(split.divisions, cells_.cell(c).corners.divisions);
  for (std::size_t c = first; c < last; ++c)
    for (const GridPoint& corner : corners_of(cells_.cell(c), split.divisions))
      split.points.push_back(corner);
  std::sort(split.points.begin(), split.points.end());
  split.points.erase(std::unique(split.points.begin(), split.points.end()), split.points.end());
  return split;
}

// Steps of the finest grid from corner k of a side to the point of edge k.
std::uint32_t steps_along(std::uint32_t i, std::uint32_t j, std::uint32_t n, int edge) {
  return edge == 0 ? i : edge == 1 ? j : n - j;
}

// The corners of cells strictly inside edge k of a side, counted from the end of the edge with the smaller
// vertex index.
std::vector<std::uint32_t> TopologyBuilder::steps_on_edge(SideId side, int k) const {
  const std::uint32_t n = finest_divisions(side);
  std::vector<std::uint32_t> steps;
  const SplitSide* split = split_side(side);
  if (split == nullptr) {
    for (std::uint32_t s = 1; s < n; ++s) steps.push_back(s);
    return steps;
  }
  const bool down = runs_down(triangle_of(side), k);
  for (const GridPoint& g : split->points) {
    const bool on_edge = k == 0 ? g.j == 0 : k == 1 ? g.i + g.j == n : g.i == 0;
    const std::uint32_t s = steps_along(g.i, g.j, n, k);
    if (on_edge && s > 0 && s < n) steps.push_back(down ? n - s : s);
  }
  return steps;
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
  const std::uint32_t n = finest_divisions(p);
  const std::uint32_t m = other == SmoothPatches::kNone ? 1 : finest_divisions(SideId(other / 3));
  EdgeVertices& edge = edges_[slot];
  edge.scale = std::lcm(n, m);
  for (const std::uint32_t s : steps_on_edge(p, k)) edge.position.push_back(s * (edge.scale / n));
  if (other != SmoothPatches::kNone)
    for (const std::uint32_t s : steps_on_edge(SideId(other / 3), static_cast<int>(other % 3)))
      edge.position.push_back(s * (edge.scale / m));
  std::sort(edge.position.begin(), edge.position.end());
  edge.position.erase(std::unique(edge.position.begin(), edge.position.end()), edge.position.end());
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
  if (split_now_ != nullptr) {
    const auto found = std::lower_bound(interior_.begin(), interior_.end(), g);
    return first_interior_ + static_cast<std::uint32_t>(found - interior_.begin());
  }
  // Row i of the interior holds n-1-i vertices.
  return first_interior_ + (g.i - 1) * (n_ - 1) - g.i * (g.i - 1) / 2 + g.j - 1;
}

void TopologyBuilder::add_interior_vertices() {
  first_interior_ = static_cast<std::uint32_t>(out_.n_vertices());
  interior_.clear();
  if (split_now_ != nullptr) {
    for (const GridPoint& g : split_now_->points)
      if (g.i > 0 && g.j > 0 && g.i + g.j < n_) interior_.push_back(g);
    for (const GridPoint& g : interior_) add_interior_vertex(g);
    return;
  }
  for (std::uint32_t i = 1; i + 1 < n_; ++i)
    for (std::uint32_t j = 1; i + j < n_; ++j) add_interior_vertex(grid_point(i, j));
}

void TopologyBuilder::add_interior_vertex(const GridPoint& g) {
  const double u = static_cast<double>(g.i) / n_;
  const double v = static_cast<double>(g.j) / n_;
  const Vec3 normal = mesh_.triangle(triangle_).is_curved()
                          ? Vec3((front_ ? 1 : -1) * mesh_.normal(triangle_, u, v))
                          : Vec3((1 - u - v) * corner_normal(patch_, 0) + u * corner_normal(patch_, 1) +
                                 v * corner_normal(patch_, 2));
  add_vertex(mesh_.point(triangle_, u, v), normal);
}

// Appends the corners of smaller cells between two points inside the patch.
void TopologyBuilder::append_between(const GridPoint& from, const GridPoint& to) {
  if (!has_middle(from, to)) return;
  const GridPoint middle = middle_of(from, to);
  if (!std::binary_search(interior_.begin(), interior_.end(), middle)) return;
  append_between(from, middle);
  polygon_.emplace_back(static_cast<int>(vertex_at(middle)));
  append_between(middle, to);
}

// The edge of the patch that both points lie on, or -1.
int TopologyBuilder::edge_of(const GridPoint& a, const GridPoint& b) const {
  if (a.j == 0 && b.j == 0) return 0;
  if (a.i == 0 && b.i == 0) return 2;
  return std::uint32_t{a.i} + a.j == n_ && std::uint32_t{b.i} + b.j == n_ ? 1 : -1;
}

// Appends the corner `from` and what lies between it and `to`.
void TopologyBuilder::append_side(const GridPoint& from, const GridPoint& to) {
  polygon_.emplace_back(static_cast<int>(vertex_at(from)));
  const int edge = edge_of(from, to);
  if (edge < 0) {
    if (split_now_ != nullptr) append_between(from, to);
    return;
  }
  const EdgeVertices& finer = edge_vertices(edge);
  if (finer.scale == n_ && split_now_ == nullptr) return;
  const auto steps = [&](const GridPoint& g) { return steps_along(g.i, g.j, n_, edge); };
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

void TopologyBuilder::add_cell(const SideCell& cell) {
  polygon_.clear();
  const auto [a, b, c] = corners_of(cell, n_);
  append_side(a, b);
  append_side(b, c);
  append_side(c, a);
  if (!front_) std::reverse(polygon_.begin(), polygon_.end());
  OpenMesh::FaceHandle face;
  if (can_add()) face = out_.add_face(polygon_);
  if (!face.is_valid()) {  // sheets that meet in an edge or a point: this cell gets vertices of its own
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
  n_ = finest_divisions(patch_);
  split_now_ = split_side(patch_);
  add_interior_vertices();
  for (std::size_t c = cells_.first(patch_); c < cells_.first(SideId(patch_.index() + 1)); ++c)
    add_cell(cells_.cell(c));
}

}  // namespace

ZoneTopology make_zone_topology(const ZoneMesh& mesh, double crease_angle_deg) {
  return TopologyBuilder(mesh, crease_angle_deg).build();
}

}  // namespace reemit
