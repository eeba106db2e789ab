#include "mesh/contact/contact_split.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mesh/contact/group_outlines.h"
#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/find_in_blocks.h"
#include "mesh/pieces/contact_segments.h"
#include "mesh/pieces/convex_region.h"
#include "mesh/pieces/edge_points.h"
#include "mesh/pieces/plane_boxes.h"
#include "mesh/pieces/segment_crossings.h"
#include "mesh/shapes/shape_contacts.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

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
    std::vector<IndexedBox> boxes;
    boxes.reserve(edges_.size());
    for (const Segment& e : edges_) {
      const Vec2 a = group.plane.project(vertices[e[0]]);
      const Vec2 b = group.plane.project(vertices[e[1]]);
      boxes.push_back(box_in_plane(a.cwiseMin(b), a.cwiseMax(b), boxes.size()));
    }
    edge_tree_ = BoxTree(std::move(boxes));
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
  BoxTree edge_tree_;           // around them, in the plane
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
  const EdgePoints between = vertices_on_edges(nodes_, edges, used, snap_);
  std::vector<Segment> out;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::uint32_t from = segments[i][0];
    for (const std::uint32_t node : between.on(i)) {
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
  constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t nearest = kNone;
  const Vec2 reach = Vec2::Constant(snap_);
  edge_tree_.visit(NearRectangle(p - reach, p + reach), [&](std::uint32_t i) {
    const Segment& e = edges_[i];
    const double d = squared_distance_to_segment(p, group_.plane.project(vertices_[e[0]]),
                                                 group_.plane.project(vertices_[e[1]]));
    if (d > best || (d == best && nearest != kNone && nearest > i)) return;
    best = d;
    nearest = i;
  });
  std::uint32_t vertex = 0;
  if (nearest != kNone) {
    const auto [first, last] = std::minmax(edges_[nearest][0], edges_[nearest][1]);
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
  // Lines that cross this often are the contact of a thicket; its shortest are ignored.
  while (count_crossings(raw, kMostPlaneCrossings) > kMostPlaneCrossings) {
    if (!ignored)
      std::stable_sort(raw.begin(), raw.end(), [](const PlanarSegment& x, const PlanarSegment& y) {
        return (x.to - x.from).squaredNorm() > (y.to - y.from).squaredNorm();
      });
    ignored = true;
    raw.resize(raw.size() / 2);
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

// Finds where pieces and shapes are in contact with groups; shapes are numbered after the pieces.
class ContactSearch {
 public:
  ContactSearch(const std::vector<FacePiece>& pieces, const PieceGroups& groups, const NearPieces& near,
                const MeshTolerances& tolerances, const VertexTable& vertices,
                std::span<const CurvedShape> shapes)
      : pieces_(pieces),
        groups_(groups),
        near_(near),
        tolerances_(tolerances),
        vertices_(vertices),
        shapes_(shapes),
        shape_tree_(boxes_of(shapes, 0)) {}

  /// Space that one group after the other is looked at in.
  struct Scratch {
    std::vector<std::size_t> others;
    std::vector<std::size_t> near;
    std::vector<PlanarSegment> sections;
  };

  /// Sets `contacts` to the contacts within the pieces of a group. Returns how many pieces it looked at.
  std::size_t find(std::size_t g, Scratch& scratch, std::vector<PlanarSegment>& contacts) const {
    contacts.clear();
    const PieceGroup group = groups_[g];
    double diameter = 0;
    for (const std::size_t p : group.pieces) diameter = std::max(diameter, pieces_[p].diameter);
    const std::size_t looks = find_candidates(g, diameter, scratch.others);
    if (scratch.others.empty()) return looks;
    const GroupOutlines outlines(vertices_, pieces_, group);
    for (const std::size_t other : scratch.others) {
      const double contact = reach(diameter, size(other));
      scratch.sections.clear();
      if (other < pieces_.size())
        section_with_plane(vertices_, pieces_[other], group.plane, contact, scratch.sections);
      else
        section_with_plane(shapes_[other - pieces_.size()], group.plane, contact, scratch.sections);
      for (const PlanarSegment& s : scratch.sections) {
        outlines.near(s.from.cwiseMin(s.to), s.from.cwiseMax(s.to), scratch.near);
        for (const std::size_t k : scratch.near) clip_to_loops(s, outlines[k], tolerances_.snap, contacts);
      }
    }
    return looks;
  }

 private:
  /// Small faces touch only from nearer: the tolerance must stay a small part of their own size [m].
  double reach(double diameter, double other) const {
    constexpr double kShareOfSize = 0.02;
    return std::max(tolerances_.weld,
                    std::min(tolerances_.contact, kShareOfSize * std::min(diameter, other)));
  }
  double size(std::size_t other) const {
    return other < pieces_.size() ? pieces_[other].diameter
                                  : std::sqrt(shape_area(shapes_[other - pieces_.size()]));
  }

  /// What may be in contact with a group, in ascending order. Returns how many pieces it looked at.
  std::size_t find_candidates(std::size_t g, double diameter, std::vector<std::size_t>& out) const {
    out.clear();
    std::size_t looks = 0;
    const PieceGroup group = groups_[g];
    // One weld distance more than needed, so that rounding loses nothing.
    const double widest = reach(diameter, diameter) + tolerances_.weld;
    for (const std::size_t p : group.pieces) {
      // Cuts nearer to the boundary than the snapping distance are none. So the neighbours that share an edge
      // or a corner, most of what is near, are not looked at.
      const auto region =
          ConvexRegion::of_piece(vertices_, pieces_[p], group.plane, widest, 0.5 * tolerances_.snap);
      looks += near_.visit(region, [&](std::uint32_t i) {
        if (groups_.group_of[i] != g) out.push_back(i);
      });
      shape_tree_.visit([&](const Vec3& low, const Vec3& high) { return region.touches(low, high); },
                        [&](std::uint32_t shape) { out.push_back(pieces_.size() + shape); });
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return looks;
  }

  const std::vector<FacePiece>& pieces_;
  const PieceGroups& groups_;
  const NearPieces& near_;
  const MeshTolerances& tolerances_;
  const VertexTable& vertices_;
  std::span<const CurvedShape> shapes_;
  BoxTree shape_tree_;
};

// Of one group.
struct FoundContacts {
  std::vector<PlanarSegment> segments;
  std::size_t looks = 0;  // that finding them took
};

}  // namespace

ContactCuts find_contact_cuts(const Scene& scene, const std::vector<FacePiece>& pieces,
                              const PieceGroups& groups, const NearPieces& near,
                              const MeshTolerances& tolerances, const WorkStep& step, VertexTable& vertices,
                              std::span<const CurvedShape> shapes) {
  ContactCuts out;
  out.segments.resize(groups.size());
  const ContactSearch search(pieces, groups, near, tolerances, vertices, shapes);
  LookLimit limit(scene, pieces);
  // Cuts add vertices; contacts are found from those that were there before.
  find_in_blocks<FoundContacts>(
      groups.size(), step,
      [&] {
        return [&, scratch = ContactSearch::Scratch()](std::size_t g, FoundContacts& found) mutable {
          found.looks = search.find(g, scratch, found.segments);
        };
      },
      [&](std::size_t g, const FoundContacts& found) {
        const PieceGroup group = groups[g];
        limit.add(group.pieces[0], found.looks);
        if (found.segments.empty()) return;
        bool ignored = false;
        out.segments[g] = CutArrangement(pieces, group, tolerances, vertices)
                              .arrange(found.segments, ignored, out.on_boundary);
        if (ignored) ++out.ignored;
      });
  return out;
}

}  // namespace reemit
