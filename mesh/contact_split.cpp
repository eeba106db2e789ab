#include "mesh/contact_split.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mesh/box_pairs.h"
#include "mesh/contact_segments.h"
#include "mesh/edge_points.h"
#include "mesh/shape_contacts.h"

namespace reemit {
namespace {

// More cuts than this in one face are the contact of a thicket (grass, hair); its shortest lines are ignored.
constexpr std::size_t kMostCuts = 20000;

using Segment = std::array<std::uint32_t, 2>;

// Brings the raw cuts of one group into order: ends snap to corners, edges and each other, and cuts end where
// others meet them. Nodes are numbered locally; node k is at nodes_[k] in the plane.
class CutArrangement {
 public:
  CutArrangement(const std::vector<FacePiece>& pieces, const PieceGroup& group,
                 const MeshTolerances& tolerances, VertexTable& vertices)
      : group_(group), snap_(tolerances.snap), vertices_(vertices), nodes_(tolerances.snap) {
    for (const std::size_t p : group.pieces) {
      for (const Loop& loop : pieces[p].loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          edges_.push_back({loop[i], loop[(i + 1) % loop.size()]});
          const std::uint32_t node = node_at(group.plane.project(vertices[loop[i]]));
          vertex_of_.try_emplace(node, loop[i]);
        }
      }
    }
  }

  std::vector<Segment> arrange(std::vector<PlanarSegment> raw, bool& ignored,
                               std::vector<std::uint32_t>& on_boundary);

 private:
  std::uint32_t node_at(const Vec2& p) { return nodes_.weld({p.x(), p.y(), 0}); }
  Vec2 position(std::uint32_t node) const { return nodes_[node].head<2>(); }
  std::vector<Segment> split_at_nodes(const std::vector<Segment>& segments) const;
  std::uint32_t vertex_at(std::uint32_t node, std::vector<std::uint32_t>& on_boundary);

  const PieceGroup& group_;
  double snap_;
  VertexTable& vertices_;
  VertexTable nodes_;
  std::vector<Segment> edges_;  // of the pieces, as vertices
  std::unordered_map<std::uint32_t, std::uint32_t> vertex_of_;
};

void sort_unique(std::vector<Segment>& segments) {
  for (Segment& s : segments)
    if (s[0] > s[1]) std::swap(s[0], s[1]);
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
}

std::vector<Segment> CutArrangement::split_at_nodes(const std::vector<Segment>& segments) const {
  std::vector<VertexEdge> edges;
  std::vector<std::uint32_t> used;
  for (const Segment& s : segments) {
    edges.push_back({s[0], s[1]});
    used.insert(used.end(), s.begin(), s.end());
  }
  for (const auto& [node, vertex] : vertex_of_) used.push_back(node);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const auto between = vertices_on_edges(nodes_, edges, used, snap_);
  std::vector<Segment> out;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::uint32_t from = segments[i][0];
    for (const std::uint32_t node : between[i]) {
      out.push_back({from, node});
      from = node;
    }
    out.push_back({from, segments[i][1]});
  }
  return out;
}

// The vertex of a node: a corner, a new point on an edge, or a new point in the plane.
std::uint32_t CutArrangement::vertex_at(std::uint32_t node, std::vector<std::uint32_t>& on_boundary) {
  const auto known = vertex_of_.find(node);
  if (known != vertex_of_.end()) return known->second;
  const Vec2 p = position(node);
  double best = snap_ * snap_;
  const Segment* nearest = nullptr;
  for (const Segment& e : edges_) {
    const double d = squared_distance_to_segment(p, group_.plane.project(vertices_[e[0]]),
                                                 group_.plane.project(vertices_[e[1]]));
    if (d <= best) {
      best = d;
      nearest = &e;
    }
  }
  std::uint32_t vertex = 0;
  if (nearest != nullptr) {
    const auto [first, last] = std::minmax((*nearest)[0], (*nearest)[1]);
    const Vec3 a = vertices_[first];
    const Vec3 along = vertices_[last] - a;
    const double t = std::clamp((group_.plane.lift(p) - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    vertex = vertices_.weld(a + t * along);
    on_boundary.push_back(vertex);
  } else {
    vertex = vertices_.weld(group_.plane.lift(p));
  }
  vertex_of_.emplace(node, vertex);
  return vertex;
}

std::vector<Segment> CutArrangement::arrange(std::vector<PlanarSegment> raw, bool& ignored,
                                             std::vector<std::uint32_t>& on_boundary) {
  if (raw.size() > kMostCuts) {
    ignored = true;
    std::stable_sort(raw.begin(), raw.end(), [](const PlanarSegment& a, const PlanarSegment& b) {
      return (a.to - a.from).squaredNorm() > (b.to - b.from).squaredNorm();
    });
    raw.resize(kMostCuts);
  }
  std::vector<Segment> segments;
  for (const PlanarSegment& s : raw) {
    const Segment nodes{node_at(s.from), node_at(s.to)};
    if (nodes[0] != nodes[1]) segments.push_back(nodes);
  }
  sort_unique(segments);
  segments = split_at_nodes(segments);
  sort_unique(segments);
  std::vector<Segment> out;
  for (const Segment& s : segments) {
    const Segment ends{vertex_at(s[0], on_boundary), vertex_at(s[1], on_boundary)};
    if (ends[0] != ends[1]) out.push_back(ends);
  }
  sort_unique(out);
  return out;
}

// Pairs (group, piece) whose boxes touch. Shapes are numbered after the pieces.
std::vector<std::pair<std::size_t, std::size_t>> candidates(const std::vector<FacePiece>& pieces,
                                                            const PieceGroups& groups, double contact,
                                                            const VertexTable& vertices,
                                                            std::span<const CurvedShape> shapes) {
  std::vector<IndexedBox> boxes;
  boxes.reserve(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) boxes.push_back(box_of(vertices, pieces[i], i, contact));
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for_each_box_pair(boxes, [&](std::uint32_t i, std::uint32_t j) {
    if (groups.group_of[i] == groups.group_of[j]) return;
    out.emplace_back(groups.group_of[i], j);
    out.emplace_back(groups.group_of[j], i);
  });
  for_each_box_pair(boxes, boxes_of(shapes, contact), [&](std::uint32_t piece, std::uint32_t shape) {
    out.emplace_back(groups.group_of[piece], pieces.size() + shape);
  });
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

ContactCuts find_contact_cuts(const std::vector<FacePiece>& pieces, const PieceGroups& groups,
                              const MeshTolerances& tolerances, VertexTable& vertices,
                              std::span<const CurvedShape> shapes) {
  ContactCuts out;
  out.segments.resize(groups.groups.size());
  const auto pairs = candidates(pieces, groups, tolerances.contact, vertices, shapes);
  std::vector<PlanarSegment> sections;
  std::vector<PlanarSegment> raw;
  for (auto it = pairs.begin(); it != pairs.end();) {
    const std::size_t g = it->first;
    const PieceGroup& group = groups.groups[g];
    std::vector<PlanarLoops> loops;
    double diameter = 0;
    for (const std::size_t p : group.pieces) {
      loops.emplace_back(vertices, pieces[p], group.plane);
      diameter = std::max(diameter, pieces[p].diameter);
    }
    raw.clear();
    for (; it != pairs.end() && it->first == g; ++it) {
      const bool is_piece = it->second < pieces.size();
      const std::size_t other = is_piece ? it->second : it->second - pieces.size();
      const double size = is_piece ? pieces[other].diameter : std::sqrt(shape_area(shapes[other]));
      // Small faces touch only from nearer: the tolerance must stay a small part of their own size.
      constexpr double kShareOfSize = 0.02;
      const double contact =
          std::max(tolerances.weld, std::min(tolerances.contact, kShareOfSize * std::min(diameter, size)));
      sections.clear();
      if (is_piece)
        section_with_plane(vertices, pieces[other], group.plane, contact, sections);
      else
        section_with_plane(shapes[other], group.plane, contact, sections);
      for (const PlanarSegment& s : sections)
        for (const PlanarLoops& l : loops) clip_to_loops(s, l, tolerances.snap, raw);
    }
    if (raw.empty()) continue;
    bool ignored = false;
    out.segments[g] =
        CutArrangement(pieces, group, tolerances, vertices).arrange(raw, ignored, out.on_boundary);
    if (ignored) ++out.ignored;
  }
  return out;
}

}  // namespace reemit
