#include "mesh/overlap/coplanar_overlap.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "mesh/geometry/disjoint_sets.h"
#include "mesh/geometry/find_in_blocks.h"
#include "mesh/pieces/back_to_back.h"
#include "mesh/pieces/convex_region.h"
#include "mesh/pieces/face_notes.h"
#include "mesh/pieces/planar_triangulation.h"
#include "mesh/pieces/segment_crossings.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

// Pairs of faces that overlap, of which all are kept until the groups are known, and the crossings of their
// outlines: bounds for rooms of any size, and for each face of large ones.
constexpr std::size_t kMostOverlaps = 10'000'000;
constexpr std::size_t kMostOverlapsPerFace = 10;
constexpr std::size_t kMostCrossingsPerFace = 10;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

struct Crossing {
  double t;  // along the first segment
  double s;  // along the second
};

// Where two segments cross with all ends farther than `margin` from the other's line.
std::optional<Crossing> proper_crossing(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1,
                                        double margin) {
  const Vec2 a = a1 - a0;
  const Vec2 b = b1 - b0;
  const double margin_a = margin * a.norm();
  const double margin_b = margin * b.norm();
  const double b0_side = cross(a, b0 - a0);
  const double b1_side = cross(a, b1 - a0);
  const double a0_side = cross(b, a0 - b0);
  const double a1_side = cross(b, a1 - b0);
  const auto opposite = [](double x, double y, double m) { return (x > m && y < -m) || (x < -m && y > m); };
  if (!opposite(b0_side, b1_side, margin_a) || !opposite(a0_side, a1_side, margin_b)) return std::nullopt;
  return Crossing{a0_side / (a0_side - a1_side), b0_side / (b0_side - b1_side)};
}

// What a piece overlaps of those that are smaller.
struct Overlaps {
  std::vector<std::uint32_t> pieces;
  std::size_t looks = 0;  // that finding them took
};

class OverlapSearch {
 public:
  OverlapSearch(const Scene& scene, const std::vector<FacePiece>& pieces, const NearPieces& near,
                const MeshTolerances& tolerances, VertexTable& vertices)
      : scene_(scene),
        pieces_(pieces),
        near_(near),
        tolerances_(tolerances),
        margin_(4 * tolerances.weld),
        vertices_(vertices),
        inner_points_(pieces.size()) {}

  PieceGroups run(const WorkStep& step);

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping_pairs(const WorkStep& step);
  [[noreturn]] void refuse(std::size_t piece, std::size_t most, const char* what) const;
  bool coplanar(const FacePiece& large, const FacePiece& small) const;
  bool overlap(std::size_t i, std::size_t j, const PlaneFrame& plane);
  void find_overlaps(std::uint32_t large, Overlaps& found);
  bool pokes_into(const PlanarLoops& inner, const PlanarLoops& outer) const;
  Vec3 inner_point(std::size_t i);
  HiddenLines hidden_lines(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) const;
  void add_crossings(std::uint32_t i, std::uint32_t j, PieceGroups& out);

  const Scene& scene_;
  const std::vector<FacePiece>& pieces_;
  const NearPieces& near_;
  const MeshTolerances& tolerances_;
  double margin_;  // overlap less deep than this is touching
  VertexTable& vertices_;
  std::mutex inner_points_mutex_;
  std::vector<std::optional<Vec3>> inner_points_;  // by piece, as far as they are known
};

void OverlapSearch::refuse(std::size_t piece, std::size_t most, const char* what) const {
  throw InputError("face " + face_name(scene_, pieces_[piece].surface, pieces_[piece].face),
                   fmt::format("more than {} {} in one plane, here and elsewhere in the room", most, what),
                   "remove the copies that are hidden, or move them apart by a millimetre");
}

bool OverlapSearch::coplanar(const FacePiece& large, const FacePiece& small) const {
  if (std::abs(large.plane.normal.dot(small.plane.normal)) < 0.99) return false;
  for (const Loop& loop : small.loops)
    for (const std::uint32_t v : loop)
      if (std::abs(large.plane.height(vertices_[v])) > tolerances_.weld) return false;
  return true;
}

Vec3 OverlapSearch::inner_point(std::size_t i) {
  const FacePiece& piece = pieces_[i];
  Vec3 point = piece.plane.origin;  // the centroid of the corners, right for triangles
  if (piece.is_triangle()) return point;
  {
    const std::lock_guard lock(inner_points_mutex_);
    if (inner_points_[i]) return *inner_points_[i];
  }
  const PlanarLoops loops(vertices_, piece, piece.plane);
  std::vector<Vec2> points;
  std::vector<std::array<std::uint32_t, 2>> segments;
  for (const auto& loop : loops.loops) {
    const auto first = static_cast<std::uint32_t>(points.size());
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t k = 0; k < count; ++k) segments.push_back({first + k, first + (k + 1) % count});
    points.insert(points.end(), loop.begin(), loop.end());
  }
  const auto cut = triangulate_planar(points, segments, [&](const Vec2& p) { return loops.contains(p); }, {});
  if (!cut.region_point.empty()) point = piece.plane.lift(cut.region_point[0]);
  const std::lock_guard lock(inner_points_mutex_);
  inner_points_[i] = point;
  return point;
}

// A corner or the middle of an edge of `inner` lies inside `outer`, clear of its boundary.
bool OverlapSearch::pokes_into(const PlanarLoops& inner, const PlanarLoops& outer) const {
  const auto clearly_inside = [&](const Vec2& p) {
    return outer.contains(p) && outer.distance_to_boundary(p) > margin_;
  };
  for (const auto& loop : inner.loops)
    for (std::size_t k = 0; k < loop.size(); ++k)
      if (clearly_inside(loop[k]) || clearly_inside(0.5 * (loop[k] + loop[(k + 1) % loop.size()])))
        return true;
  return false;
}

bool OverlapSearch::overlap(std::size_t i, std::size_t j, const PlaneFrame& plane) {
  const PlanarLoops a(vertices_, pieces_[i], plane);
  const PlanarLoops b(vertices_, pieces_[j], plane);
  const Vec2 depth = a.max.cwiseMin(b.max) - a.min.cwiseMax(b.min);
  if (depth.minCoeff() <= margin_) return false;
  for (const auto& la : a.loops)
    for (std::size_t k = 0; k < la.size(); ++k)
      for (const auto& lb : b.loops)
        for (std::size_t m = 0; m < lb.size(); ++m)
          if (proper_crossing(la[k], la[(k + 1) % la.size()], lb[m], lb[(m + 1) % lb.size()], margin_))
            return true;
  if (pokes_into(a, b) || pokes_into(b, a)) return true;
  const auto inside = [&](const PlanarLoops& loops, const Vec3& p) {
    const Vec2 q = plane.project(p);
    return loops.contains(q) && loops.distance_to_boundary(q) > margin_;
  };
  return inside(a, inner_point(j)) || inside(b, inner_point(i));
}

// Which of two overlapping pieces never keeps a spot that the other covers too: see keepers_of.
std::optional<std::uint32_t> always_loses(const std::vector<FacePiece>& pieces, std::uint32_t earlier,
                                          std::uint32_t later) {
  if (pieces[earlier].plane.normal.dot(pieces[later].plane.normal) <= 0) return std::nullopt;
  return pieces[later].emits && !pieces[earlier].emits ? earlier : later;
}

HiddenLines OverlapSearch::hidden_lines(
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hidden_by;
  for (const auto& [i, j] : pairs)
    if (const auto loser = always_loses(pieces_, i, j)) hidden_by.emplace_back(*loser, *loser == i ? j : i);
  std::sort(hidden_by.begin(), hidden_by.end());
  HiddenLines out(tolerances_);
  std::vector<std::uint32_t> hiders;
  for (std::size_t at = 0; at < hidden_by.size();) {
    const std::uint32_t piece = hidden_by[at].first;
    hiders.clear();
    for (; at < hidden_by.size() && hidden_by[at].first == piece; ++at)
      hiders.push_back(hidden_by[at].second);
    out.find(vertices_, pieces_, piece, hiders);
  }
  return out;
}

void OverlapSearch::add_crossings(std::uint32_t i, std::uint32_t j, PieceGroups& out) {
  const PlaneFrame& plane = pieces_[pieces_[i].area >= pieces_[j].area ? i : j].plane;
  for (const Loop& la : pieces_[i].loops) {
    for (std::size_t k = 0; k < la.size(); ++k) {
      const Vec3 a0 = vertices_[la[k]];
      const Vec3 a1 = vertices_[la[(k + 1) % la.size()]];
      if (out.hidden.hide(i, a0, a1)) continue;
      for (const Loop& lb : pieces_[j].loops) {
        for (std::size_t m = 0; m < lb.size(); ++m) {
          const Vec3 b0 = vertices_[lb[m]];
          const Vec3 b1 = vertices_[lb[(m + 1) % lb.size()]];
          const auto at = proper_crossing(plane.project(a0), plane.project(a1), plane.project(b0),
                                          plane.project(b1), tolerances_.weld);
          if (!at) continue;
          const Vec3 on_a = a0 + at->t * (a1 - a0);
          if (out.hidden.hide(i, on_a) || out.hidden.hide(j, on_a)) continue;
          // Half way between the edges, so that it lies within the weld distance of both.
          out.crossings.push_back(vertices_.weld(0.5 * (on_a + b0 + at->s * (b1 - b0))));
        }
      }
    }
  }
}

// Every overlapping pair is found from its larger piece, whose plane counts.
void OverlapSearch::find_overlaps(std::uint32_t large, Overlaps& found) {
  // Neighbours that share an edge or a corner reach inside by the rounding of a product, no more.
  constexpr double kRounding = 1e-3;  // of the weld distance
  const FacePiece& piece = pieces_[large];
  const auto region = ConvexRegion::of_piece(vertices_, piece, piece.plane, 2 * tolerances_.weld,
                                             kRounding * tolerances_.weld);
  found.pieces.clear();
  found.looks = near_.visit(region, [&](std::uint32_t small) {
    const FacePiece& other = pieces_[small];
    if (piece.area < other.area || (piece.area == other.area && large >= small)) return;
    if (coplanar(piece, other) && overlap(large, small, piece.plane)) found.pieces.push_back(small);
  });
}

// In ascending order.
std::vector<std::pair<std::uint32_t, std::uint32_t>> OverlapSearch::overlapping_pairs(const WorkStep& step) {
  const std::size_t most = std::max(kMostOverlaps, kMostOverlapsPerFace * pieces_.size());
  LookLimit limit(scene_, pieces_);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  find_in_blocks<Overlaps>(
      pieces_.size(), step,
      [&] {
        return [&](std::size_t i, Overlaps& found) { find_overlaps(static_cast<std::uint32_t>(i), found); };
      },
      [&](std::size_t i, const Overlaps& found) {
        limit.add(i, found.looks);
        for (const std::uint32_t small : found.pieces)
          pairs.push_back(std::minmax(static_cast<std::uint32_t>(i), small));
        if (pairs.size() > most) refuse(i, most, "pairs of faces overlap");
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

PieceGroups OverlapSearch::run(const WorkStep& step) {
  const auto pairs = overlapping_pairs(step);
  const std::size_t most = std::max(kMostPlaneCrossings, kMostCrossingsPerFace * pieces_.size());
  PieceGroups out;
  out.hidden = hidden_lines(pairs);
  DisjointSets sets(pieces_.size());
  for (const auto& [i, j] : pairs) {
    sets.join(i, j);
    add_crossings(i, j, out);
    if (out.crossings.size() > most) refuse(i, most, "crossings of outlines of overlapping faces lie");
  }
  out.group_of.resize(pieces_.size());
  std::vector<std::uint32_t> largest;
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
    const std::size_t root = sets.find(i);
    if (root == i) {
      out.group_of[i] = static_cast<std::uint32_t>(largest.size());
      largest.push_back(i);
    }
    const std::uint32_t g = out.group_of[i] = out.group_of[root];
    if (pieces_[i].area > pieces_[largest[g]].area) largest[g] = i;
  }
  out.plane.reserve(largest.size());
  for (const std::uint32_t i : largest) out.plane.push_back(&pieces_[i].plane);
  out.first.assign(largest.size() + 1, 0);
  for (const std::uint32_t g : out.group_of) ++out.first[g + 1];
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.pieces.resize(pieces_.size());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (std::uint32_t i = 0; i < pieces_.size(); ++i) out.pieces[next[out.group_of[i]]++] = i;
  return out;
}

}  // namespace

IndexedBox box_of(const VertexTable& vertices, const FacePiece& piece, std::size_t index, double margin) {
  IndexedBox box{.min = vertices[piece.loops[0][0]], .max = vertices[piece.loops[0][0]]};
  box.index = static_cast<std::uint32_t>(index);
  for (const std::uint32_t v : piece.loops[0]) {
    box.min = box.min.cwiseMin(vertices[v]);
    box.max = box.max.cwiseMax(vertices[v]);
  }
  box.min.array() -= margin;
  box.max.array() += margin;
  return box;
}

PieceGroups group_overlapping_pieces(const Scene& scene, const std::vector<FacePiece>& pieces,
                                     const NearPieces& near, const MeshTolerances& tolerances,
                                     const WorkStep& step, VertexTable& vertices) {
  return OverlapSearch(scene, pieces, near, tolerances, vertices).run(step);
}

Keepers keepers_of(const Scene& scene, const std::vector<FacePiece>& pieces,
                   const std::vector<std::size_t>& covering, const Vec3& room_centre) {
  const Vec3& facing = pieces[covering[0]].plane.normal;
  std::optional<std::size_t> same;
  std::optional<std::size_t> opposite;
  for (const std::size_t i : covering) {
    auto& best = pieces[i].plane.normal.dot(facing) > 0 ? same : opposite;
    if (!best || (pieces[i].emits && !pieces[*best].emits)) best = i;
  }
  if (!opposite) return {*same};
  if (pieces[*same].emits == pieces[*opposite].emits) {
    const auto [winner, other] = std::minmax(*same, *opposite);
    return {winner, may_be_back_to_back(scene, pieces[winner], pieces[other]) ? other : Keepers::kNobody};
  }
  const std::size_t lamp = pieces[*same].emits ? *same : *opposite;
  const std::size_t surface = lamp == *same ? *opposite : *same;
  if (!pieces[lamp].in_closed_shell) return {lamp};
  if (!pieces[surface].two_sided) return {surface};
  const bool shines_inwards = pieces[lamp].plane.height(room_centre) > 0;
  return {shines_inwards ? lamp : surface};
}

}  // namespace reemit
