#include "mesh/triangulate/triangulate_groups.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "mesh/contact/group_outlines.h"
#include "mesh/pieces/face_notes.h"
#include "mesh/pieces/plane_boxes.h"
#include "scenes/model/error.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

using Segment = std::array<std::uint32_t, 2>;

// A region of a group that no segment cuts.
struct Region {
  Keepers keepers;
  std::size_t first_loser = 0;  // of the others that cover it, in one list for all regions
  std::size_t end_of_losers = 0;
  double area = 0;  // [m2]
};

struct GroupRegions {
  std::vector<Region> regions;
  std::vector<std::size_t> losers;  // of one region after the other

  std::span<const std::size_t> losers_of(const Region& region) const {
    return std::span(losers).subspan(region.first_loser, region.end_of_losers - region.first_loser);
  }
};

// What a group is cut along, in its plane.
struct Drawing {
  std::vector<Vec2> points;
  std::vector<std::uint32_t> ids;  // vertices of the points
  std::vector<Segment> segments;   // between points
};

// Which outlines a group is cut along.
enum class Lines { kInSight, kAll };

// Area by winner and loser, in one number [m2].
using OverlapAreas = std::unordered_map<std::uint64_t, double>;

std::uint64_t pair_of(std::size_t winner, std::size_t loser) {
  return (std::uint64_t{winner} << 32) | loser;
}

// Numbers of points, neighbours close together: along strips. What one point touched in memory is still near
// when the next comes.
std::vector<std::uint32_t> order_by_place(const std::vector<Vec2>& points) {
  constexpr double kStrips = 64;
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  if (points.size() < 2) return order;
  double low = points[0].y();
  double high = low;
  for (const Vec2& p : points) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  if (!(high > low)) return order;
  std::vector<std::pair<int, double>> place;
  place.reserve(points.size());
  for (const Vec2& p : points)
    place.emplace_back(static_cast<int>((p.y() - low) / (high - low) * kStrips), p.x());
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place[a] != place[b] ? place[a] < place[b] : a < b;
  });
  return order;
}

class GroupTriangulation {
 public:
  GroupTriangulation(const Scene& scene, const std::vector<FacePiece>& pieces, const PieceGroups& groups,
                     const ContactCuts& cuts, const MeshTolerances& tolerances,
                     const TriangleQuality& quality, VertexTable& vertices, MeshReport& report)
      : scene_(scene),
        pieces_(pieces),
        groups_(groups),
        cuts_(cuts),
        tolerances_(tolerances),
        quality_(quality),
        vertices_(vertices),
        report_(report),
        meshed_(pieces.size(), 0.0),
        covered_(pieces.size(), 0.0),
        room_centre_(bounds(scene).centre()) {}

  GroupTriangles run(const WorkStep& step);

 private:
  void triangulate(std::size_t g);
  bool emit(std::size_t g, const std::vector<Segment>& cuts, const TriangleQuality& quality, Lines lines,
            Crossings crossings = Crossings::kRounded);
  Drawing draw(const PieceGroup& group, const std::vector<Segment>& cuts, Lines lines) const;
  GroupRegions find_regions(const PieceGroup& group, const GroupOutlines& outlines,
                            const PlanarTriangulation& cut, Lines lines) const;
  void add_triangles(const PieceGroup& group, const PlanarTriangulation& cut,
                     const std::vector<std::uint32_t>& ids, GroupRegions& found);
  // Whether parts of its outline are left out, behind pieces that win.
  bool is_partial(std::size_t piece, Lines lines) const {
    return lines == Lines::kInSight && groups_.hidden.any(piece);
  }
  void cover_in_parts(std::size_t g, const GroupOutlines& outlines, std::span<const RawTriangle> triangles,
                      OverlapAreas& overlap);
  std::vector<std::uint32_t> lift(const PieceGroup& group, const PlanarTriangulation& cut,
                                  std::vector<std::uint32_t> ids);
  bool conserves_area(std::size_t piece) const;
  void count_cut_pieces(std::size_t g);
  void note(FaceChange change, std::size_t piece) {
    report_.changes.push_back({pieces_[piece].surface, pieces_[piece].face, change});
  }
  // Of two pieces back to back that keep a spot the one that faces as `loser` does, which it lost it to.
  std::size_t keeper_against(const Keepers& keepers, std::size_t loser) const {
    const bool back = keepers.back != Keepers::kNobody &&
                      pieces_[keepers.back].plane.normal.dot(pieces_[loser].plane.normal) > 0;
    return back ? keepers.back : keepers.winner;
  }
  void report_overlaps();
  void report_back_to_back();
  void report_lamps_turned_away();

  double area_of(const std::array<std::uint32_t, 3>& t) const {
    return triangle_area(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
  }

  const Scene& scene_;
  const std::vector<FacePiece>& pieces_;
  const PieceGroups& groups_;
  const ContactCuts& cuts_;
  const MeshTolerances& tolerances_;
  const TriangleQuality& quality_;
  VertexTable& vertices_;
  MeshReport& report_;
  std::vector<RawTriangle> out_;
  std::vector<double> meshed_;                                     // by piece [m2]
  std::vector<double> covered_;                                    // by piece, by others that win [m2]
  std::map<std::pair<std::size_t, std::size_t>, double> overlap_;  // area by (winner, loser) [m2]
  Vec3 room_centre_;
};

// Vertices of all points of a triangulation, of which the first ones are known.
std::vector<std::uint32_t> GroupTriangulation::lift(const PieceGroup& group, const PlanarTriangulation& cut,
                                                    std::vector<std::uint32_t> ids) {
  const std::size_t given = ids.size();
  for (std::size_t i = given; i < cut.points.size(); ++i) {
    const auto [a, b] = cut.on_segment[i - given];
    if (a == PlanarTriangulation::kNone) {
      ids.push_back(vertices_.weld(group.plane.lift(cut.points[i])));
      continue;
    }
    // Along the edge in space, from its smaller vertex on, so that neighbours find the very same point.
    const bool in_order = ids[a] < ids[b];
    const std::uint32_t first = in_order ? a : b;
    const std::uint32_t last = in_order ? b : a;
    const Vec2 along = cut.points[last] - cut.points[first];
    const double t = (cut.points[i] - cut.points[first]).dot(along) / along.squaredNorm();
    const Vec3 p = vertices_[ids[first]];
    ids.push_back(vertices_.weld(p + t * (vertices_[ids[last]] - p)));
  }
  return ids;
}

// What triangles take of pieces that are not cut along all of their outlines.
void GroupTriangulation::cover_in_parts(std::size_t g, const GroupOutlines& outlines,
                                        std::span<const RawTriangle> triangles, OverlapAreas& overlap) {
  const PieceGroup group = groups_[g];
  std::vector<std::size_t> near;
  for (const RawTriangle& t : triangles) {
    const std::array corners{group.plane.project(vertices_[t.vertex[0]]),
                             group.plane.project(vertices_[t.vertex[1]]),
                             group.plane.project(vertices_[t.vertex[2]])};
    outlines.near(corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
                  corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]), near);
    for (const std::size_t k : near) {
      const std::size_t p = group.pieces[k];
      if (p == t.piece || p == t.back || !groups_.hidden.any(p)) continue;
      const double area = area_within(outlines[k], corners);
      if (!(area > 0)) continue;
      covered_[p] += area;
      overlap[pair_of(keeper_against({t.piece, t.back}, p), p)] += area;
    }
  }
  // Neighbours that only touch take slivers of rounding from each other.
  constexpr double kRounding = 1e-12;
  std::erase_if(overlap, [&](const auto& entry) {
    const double diameter = pieces_[entry.first & 0xffffffff].diameter;
    return entry.second <= kRounding * diameter * diameter;
  });
}

Drawing GroupTriangulation::draw(const PieceGroup& group, const std::vector<Segment>& cuts,
                                 Lines lines) const {
  Drawing drawing;
  std::unordered_map<std::uint32_t, std::uint32_t> local;
  const auto local_of = [&](std::uint32_t vertex) {
    const auto [it, is_new] = local.try_emplace(vertex, static_cast<std::uint32_t>(drawing.ids.size()));
    if (is_new) {
      drawing.ids.push_back(vertex);
      drawing.points.push_back(group.plane.project(vertices_[vertex]));
    }
    return it->second;
  };
  for (const std::size_t p : group.pieces) {
    const bool partial = is_partial(p, lines);
    for (const Loop& loop : pieces_[p].loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i];
        const std::uint32_t b = loop[(i + 1) % loop.size()];
        if (!partial || !groups_.hidden.hide(p, vertices_[a], vertices_[b]))
          drawing.segments.push_back({local_of(a), local_of(b)});
      }
  }
  for (const Segment& s : cuts) drawing.segments.push_back({local_of(s[0]), local_of(s[1])});
  return drawing;
}

// Who keeps and who loses each region; their areas are 0 yet. Pieces that are not cut along all of their
// outlines lose no region as a whole.
GroupRegions GroupTriangulation::find_regions(const PieceGroup& group, const GroupOutlines& outlines,
                                              const PlanarTriangulation& cut, Lines lines) const {
  GroupRegions found;
  found.regions.resize(cut.region_point.size());
  std::vector<std::size_t> covering(group.pieces.begin(), group.pieces.end());
  for (const std::uint32_t r : order_by_place(cut.region_point)) {
    if (group.pieces.size() > 1) {
      outlines.covering(cut.region_point[r], covering);
      if (covering.empty()) continue;
      for (std::size_t& k : covering) k = group.pieces[k];
    }
    Region& region = found.regions[r];
    const Keepers& keepers = region.keepers = keepers_of(scene_, pieces_, covering, room_centre_);
    region.first_loser = found.losers.size();
    std::copy_if(covering.begin(), covering.end(), std::back_inserter(found.losers), [&](std::size_t p) {
      return p != keepers.winner && p != keepers.back && !is_partial(p, lines);
    });
    region.end_of_losers = found.losers.size();
  }
  return found;
}

// Hands the triangles to those that keep them, and books the areas of regions and pieces.
void GroupTriangulation::add_triangles(const PieceGroup& group, const PlanarTriangulation& cut,
                                       const std::vector<std::uint32_t>& ids, GroupRegions& found) {
  for (const std::size_t p : group.pieces) meshed_[p] = covered_[p] = 0;
  for (std::size_t i = 0; i < cut.triangles.size(); ++i) {
    Region& region = found.regions[cut.region[i]];
    const auto [winner, back] = region.keepers;
    if (winner == Keepers::kNobody) continue;
    std::array<std::uint32_t, 3> t{ids[cut.triangles[i][0]], ids[cut.triangles[i][1]],
                                   ids[cut.triangles[i][2]]};
    const double area = area_of(t);
    region.area += area;
    for (const std::size_t p : found.losers_of(region)) covered_[p] += area;
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (pieces_[winner].plane.normal.dot(group.plane.normal) < 0) std::swap(t[1], t[2]);
    meshed_[winner] += area;
    if (back != Keepers::kNobody) meshed_[back] += area;
    out_.push_back({t, winner, back});
  }
}

// Triangulates a group; returns false, leaving no trace but unused vertices, if area was lost.
bool GroupTriangulation::emit(std::size_t g, const std::vector<Segment>& cuts, const TriangleQuality& quality,
                              Lines lines, Crossings crossings) {
  const PieceGroup group = groups_[g];
  Drawing drawing = draw(group, cuts, lines);
  const GroupOutlines outlines(vertices_, pieces_, group);
  const auto inside = [&](const Vec2& p) { return outlines.cover(p); };
  TriangleQuality limited = quality;
  limited.most_new_points = std::min(quality.most_new_points, 1000 + 10 * drawing.points.size());
  const PlanarTriangulation cut =
      triangulate_planar(drawing.points, drawing.segments, inside, limited, crossings);
  const std::vector<std::uint32_t> ids = lift(group, cut, std::move(drawing.ids));

  GroupRegions found = find_regions(group, outlines, cut, lines);
  const std::size_t before = out_.size();
  add_triangles(group, cut, ids, found);
  OverlapAreas overlap;
  if (std::any_of(group.pieces.begin(), group.pieces.end(),
                  [&](std::size_t p) { return is_partial(p, lines); }))
    cover_in_parts(g, outlines, std::span(out_).subspan(before), overlap);
  if (!std::all_of(group.pieces.begin(), group.pieces.end(),
                   [&](std::size_t p) { return conserves_area(p); })) {
    out_.resize(before);
    return false;
  }
  for (const Region& region : found.regions)
    for (const std::size_t p : found.losers_of(region))
      overlap[pair_of(keeper_against(region.keepers, p), p)] += region.area;
  for (const auto& [pair, area] : overlap) overlap_[{pair >> 32, pair & 0xffffffff}] = area;
  return true;
}

// Welding moves corners by up to the weld distance and slivers without area are left out; more must not be
// lost.
bool GroupTriangulation::conserves_area(std::size_t piece) const {
  const FacePiece& p = pieces_[piece];
  std::size_t corners = 0;
  for (const Loop& loop : p.loops) corners += loop.size();
  const double slack = 8 * tolerances_.weld * p.diameter * static_cast<double>(corners) + 1e-9 * p.area;
  return std::abs(p.area - meshed_[piece] - covered_[piece]) <= slack;
}

void GroupTriangulation::triangulate(std::size_t g) {
  const PieceGroup group = groups_[g];
  const std::vector<Segment>& cuts = cuts_.segments[g];
  if (group.pieces.size() == 1 && cuts.empty() && pieces_[group.pieces[0]].is_triangle()) {
    const Loop& t = pieces_[group.pieces[0]].loops[0];
    meshed_[group.pieces[0]] = area_of({t[0], t[1], t[2]});
    out_.push_back({{t[0], t[1], t[2]}, group.pieces[0]});
    return;
  }
  const bool any_hidden = std::any_of(group.pieces.begin(), group.pieces.end(),
                                      [&](std::size_t p) { return groups_.hidden.any(p); });
  if (any_hidden && emit(g, cuts, quality_, Lines::kInSight)) return;  // where rounding does not defeat it
  TriangleQuality plain = quality_;
  plain.most_new_points = 0;
  for (const Crossings crossings : {Crossings::kRounded, Crossings::kExact})
    if (emit(g, cuts, quality_, Lines::kAll, crossings) || emit(g, cuts, plain, Lines::kAll, crossings))
      return;
  if (emit(g, {}, plain, Lines::kAll, Crossings::kExact)) return;
  const auto lost = std::find_if(group.pieces.begin(), group.pieces.end(),
                                 [&](std::size_t p) { return !conserves_area(p); });
  const FacePiece& piece = pieces_[lost == group.pieces.end() ? group.pieces[0] : *lost];
  throw InputError("face " + face_name(scene_, piece.surface, piece.face),
                   "the polygon cannot be triangulated without changing its area",
                   "it may cross itself or overlap its holes: split it into simple polygons");
}

void GroupTriangulation::count_cut_pieces(std::size_t g) {
  const PieceGroup group = groups_[g];
  if (cuts_.segments[g].empty()) return;
  std::vector<Vec2> middles;
  std::vector<IndexedBox> boxes;
  for (const Segment& s : cuts_.segments[g]) {
    middles.push_back(group.plane.project(0.5 * (vertices_[s[0]] + vertices_[s[1]])));
    boxes.push_back(box_in_plane(middles.back(), middles.back(), boxes.size()));
  }
  const BoxTree tree(std::move(boxes));
  const GroupOutlines outlines(vertices_, pieces_, group);
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    bool cut = false;
    const NearRectangle in_box(outlines[k].min, outlines[k].max);
    tree.visit([&](const Vec3& min, const Vec3& max) { return !cut && in_box(min, max); },
               [&](std::uint32_t i) { cut = cut || outlines[k].contains(middles[i]); });
    if (!cut) continue;
    ++report_.cut_faces;
    note(FaceChange::kCut, group.pieces[k]);
  }
}

void GroupTriangulation::report_overlaps() {
  std::map<std::size_t, double> lost;
  std::map<std::pair<SurfaceId, SurfaceId>, double> by_surface;
  double total = 0;
  std::size_t last_winner = pieces_.size();
  for (const auto& [pair, area] : overlap_) {
    lost[pair.second] += area;
    by_surface[{pieces_[pair.first].surface, pieces_[pair.second].surface}] += area;
    total += area;
    if (pair.first != last_winner) note(FaceChange::kCovers, pair.first);
    last_winner = pair.first;
  }
  for (const auto& [piece, area] : lost) note(FaceChange::kCovered, piece);
  report_.overlapping_faces = lost.size();
  if (lost.empty()) return;
  std::vector<std::pair<double, std::pair<SurfaceId, SurfaceId>>> largest;
  for (const auto& [pair, area] : by_surface) largest.emplace_back(area, pair);
  std::stable_sort(largest.begin(), largest.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(kNamed, largest.size()); ++i)
    names += fmt::format("{}'{}' covers {:.4g} m2 of '{}'", i == 0 ? "" : ", ",
                         scene_.surfaces[largest[i].second.first.index()].name, largest[i].first,
                         scene_.surfaces[largest[i].second.second.index()].name);
  if (largest.size() > kNamed) names += fmt::format(" and {} more pairs", largest.size() - kNamed);
  report_.warnings.push_back(fmt::format(
      "{} faces lie in one plane with a face that covers them; {:.4g} m2 were removed: {}. The "
      "luminaire stays, else the earlier face; matt faces keep one side each if their fronts look "
      "apart and neither bounds a solid. Give what is to be seen, a poster on a wall, a millimetre of "
      "distance",
      lost.size(), total, names));
}

// Faces of pairs that keep one side each.
void GroupTriangulation::report_back_to_back() {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const RawTriangle& t : out_)
    if (t.back != Keepers::kNobody) pairs.emplace(t.piece, t.back);
  report_.back_to_back_faces = pairs.size();
  for (const auto& [front, back] : pairs) {
    note(FaceChange::kBackToBack, front);
    note(FaceChange::kBackToBack, back);
  }
}

// A lamp in the plane of a one-sided face that looks the other way lights what is behind that face, which is
// hardly meant.
void GroupTriangulation::report_lamps_turned_away() {
  std::map<std::size_t, double> turned;  // area by winner
  std::string first;
  for (const auto& [pair, area] : overlap_) {
    const FacePiece& lamp = pieces_[pair.first];
    const FacePiece& behind = pieces_[pair.second];
    const Material& material = scene_.material_of(scene_.surfaces[lamp.surface.index()]);
    if (!material.emits() || material.emits_both_sides ||
        scene_.material_of(scene_.surfaces[behind.surface.index()]).two_sided ||
        lamp.plane.normal.dot(behind.plane.normal) > 0)
      continue;
    if (turned.empty())
      first = fmt::format("'{}' lies in '{}'", scene_.surfaces[lamp.surface.index()].name,
                          scene_.surfaces[behind.surface.index()].name);
    turned[pair.first] += area;
  }
  if (turned.empty()) return;
  double area = 0;
  for (const auto& [lamp, part] : turned) area += part;
  report_.warnings.push_back(fmt::format(
      "{} luminous faces, {:.4g} m2, lie in one-sided faces and shine out of their backs ({}): turn them "
      "round if they should light the side that those faces look to",
      turned.size(), area, first));
}

GroupTriangles GroupTriangulation::run(const WorkStep& step) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    step.at(g, groups_.size());
    triangulate(g);
    count_cut_pieces(g);
  }
  report_overlaps();
  report_back_to_back();
  report_lamps_turned_away();
  return {std::move(out_), std::move(covered_)};
}

}  // namespace

GroupTriangles triangulate_groups(const Scene& scene, const std::vector<FacePiece>& pieces,
                                  const PieceGroups& groups, const ContactCuts& cuts,
                                  const MeshTolerances& tolerances, const TriangleQuality& quality,
                                  const WorkStep& step, VertexTable& vertices, MeshReport& report) {
  return GroupTriangulation(scene, pieces, groups, cuts, tolerances, quality, vertices, report).run(step);
}

}  // namespace reemit
