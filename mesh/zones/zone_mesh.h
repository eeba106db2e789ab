#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/zones/base_mesh.h"
#include "mesh/zones/cell_corners.h"
#include "mesh/zones/cell_splits.h"
#include "mesh/zones/curved_patch.h"
#include "mesh/zones/side.h"
#include "mesh/zones/side_cell.h"
#include "mesh/zones/zone_groups.h"
#include "mesh/zones/zone_lookup.h"
#include "scenes/model/ids.h"
#include "scenes/model/vec.h"

namespace reemit {

/// 16 points on sides of base triangles. Every lane counts: fill those that are not used with no triangle.
struct TrianglePoints16 {
  const std::uint32_t* triangle;  ///< ZoneMesh::kNone for none.
  const float *u, *v;             ///< Barycentric.
  const bool* front;
};

/// Base triangles and their zones: the one place that knows what a zone is, which zone a point belongs to,
/// and where the points of a zone are. A zone is one cell of a base triangle seen from one side, a part of a
/// cell that is cut further (CellSplits), or a group of whole sides of triangles (ZoneGroups). The back of a
/// two-sided triangle has zones of its own; groups come after all cells. No radiometric value is stored here.
class ZoneMesh {
 public:
  /// Throws std::invalid_argument when an index is out of range, patches are not in order, divisions is 0,
  /// backs are of another number of triangles, or of one that is curved or one-sided,
  /// the zones exceed 2^32-2, a group is empty, mixes surfaces or fronts with backs, or has a side that has
  /// no zones, divisions exceed 65535, or splits do not end, are of another number of cells or cut finer than
  /// kMostDivisions.
  explicit ZoneMesh(BaseMesh base, ZoneGroups groups = {}, CellSplits splits = {});

  const BaseMesh& base() const { return base_; }
  BaseMesh release_base() && { return std::move(base_); }
  const ZoneGroups& groups() const { return groups_; }
  const CellSplits& splits() const { return splits_; }
  std::size_t triangle_count() const { return base_.triangles.size(); }
  std::size_t side_count() const { return reemit::side_count(triangle_count()); }  ///< With zones or without.
  std::size_t zone_count() const { return zone_side_.size(); }
  std::size_t cell_zone_count() const { return zone_count() - groups_.count; }  ///< Of zones that are cells.
  bool is_group(ZoneId z) const { return z.index() >= cell_zone_count(); }
  /// A group of sides that no light reaches.
  bool is_sealed(ZoneId z) const { return is_group(z) && z.index() - cell_zone_count() < groups_.sealed; }

  const BaseTriangle& triangle(TriangleId t) const { return base_.triangles[t.index()]; }
  /// Whether the back shows the front of another face than the front does.
  bool is_back_to_back(TriangleId t) const {
    return !base_.backs.empty() && base_.backs[t.index()].surface.valid();
  }
  /// The face that a side shows.
  SurfaceFace face(TriangleId t, bool front) const {
    if (!front && is_back_to_back(t)) return base_.backs[t.index()];
    return {triangle(t).surface, triangle(t).face};
  }
  SurfaceId surface(TriangleId t, bool front) const { return face(t, front).surface; }
  SurfaceId surface(SideId side) const { return surface(triangle_of(side), is_front(side)); }
  /// Whether it shows the front of that face.
  bool shows_front(SideId side) const { return is_front(side) || is_back_to_back(triangle_of(side)); }
  const Vec3& corner(TriangleId t, int k) const {
    return base_.vertices[triangle(t).vertex[static_cast<std::size_t>(k)]];
  }
  double triangle_area(TriangleId t) const { return triangle_area_[t.index()]; }  ///< One side [m2].
  /// Unit, of the front; of a curved patch, in its middle.
  const Vec3& triangle_normal(TriangleId t) const { return triangle_normal_[t.index()]; }
  /// Unit, points away from that side.
  Vec3 side_normal(SideId side) const {
    const Vec3& normal = triangle_normal(triangle_of(side));
    return is_front(side) ? normal : Vec3(-normal);
  }
  /// Unit normal of the front at (u,v).
  Vec3 normal(TriangleId t, double u, double v) const {
    const BaseTriangle& tri = triangle(t);
    return tri.is_curved() ? curved_[tri.shape].normal(tri.patch, u, v) : triangle_normal(t);
  }

  std::size_t flat_count() const { return flat_count_; }  ///< Triangles that are flat; they come first.
  const std::vector<CurvedPatches>& curved() const { return curved_; }  ///< As BaseMesh::shapes.
  /// First patch of a shape.
  TriangleId first_patch(std::size_t shape) const { return first_patch_[shape]; }

  /// First zone on the given side, or its group; not valid for the back of a one-sided triangle.
  ZoneId first_zone(TriangleId t, bool front) const { return side(t, front).first_zone; }
  /// The back of a one-sided triangle has none.
  bool has_zones(TriangleId t, bool front) const { return first_zone(t, front).valid(); }
  bool has_zones(SideId side) const { return sides_[side.index()].first_zone.valid(); }
  /// Zone that holds barycentric point (u,v) of the given side, in constant time; not valid if that side has
  /// none.
  ZoneId zone_at(TriangleId t, float u, float v, bool front) const {
    const Side& s = side(t, front);
    if (!s.first_zone.valid()) return ZoneId();
    if (s.nodes != kWhole) return zone_in_parts(s, u, v);
    return ZoneId(s.first_zone.index() + zone_in_triangle(s.divisions, u, v));
  }
  static constexpr std::uint32_t kNone = 0xffffffff;  ///< Number of no triangle, or of no zone.
  /// Asks for the memory that zones_at16 and `member` will look at, before it is needed.
  void prefetch(TriangleId t) const {
    __builtin_prefetch(&sides_[2 * t.index()]);
    if (!member_.empty()) __builtin_prefetch(&member_[2 * t.index()]);
  }
  /// zone_at for 16 points, in less than half of the time: numbers of zones, kNone where there is none.
  void zones_at16(const TrianglePoints16& points, std::uint32_t* zone) const;
  /// The cell that a zone is. Pre: not a group.
  SideCell zone_cell(ZoneId z) const {
    const SideId side = zone_side_[z.index()];
    return {triangle_of(side), is_front(side), zone_corners_[z.index()]};
  }
  /// A cell of the zone, chosen in proportion to areas by a uniform number, which is uniform again
  /// afterwards: the zone itself, or a member of the group.
  SideCell pick_cell(ZoneId z, float& u) const { return is_group(z) ? member_cell(z, u) : zone_cell(z); }
  /// Number of a side within its group. Pre: it is in one.
  std::uint32_t member(TriangleId t, bool front) const { return member_[side_of(t, front).index()]; }
  /// The triangle of a member of a group.
  TriangleId member_triangle(ZoneId group, std::uint32_t member) const {
    return triangle_of(members_[first_member(group) + member]);
  }
  std::size_t member_count(ZoneId group) const {
    return first_member_[group.index() - cell_zone_count() + 1] - first_member(group);
  }

  SideId zone_side(ZoneId z) const { return zone_side_[z.index()]; }  ///< Of a group, its first member.
  /// The zone's parent; of a group, its first member.
  TriangleId zone_triangle(ZoneId z) const { return triangle_of(zone_side_[z.index()]); }
  bool zone_is_front(ZoneId z) const { return is_front(zone_side_[z.index()]); }
  SurfaceId zone_surface(ZoneId z) const { return surface(zone_side(z)); }
  /// Whether the zone lies on the front of its surface, which may be the back of a triangle.
  bool zone_shows_front(ZoneId z) const { return shows_front(zone_side(z)); }
  double zone_area(ZoneId z) const;  ///< Of what is there of it, where it is a cut-out [m2].
  /// Share of the zone that is there [0,1]: below 1 for cut-outs, whose holes light passes through.
  double solid_share(ZoneId z) const {
    return solid_shares_.empty() ? 1 : static_cast<double>(solid_shares_[z.index()]);
  }
  const std::vector<float>& solid_shares() const { return solid_shares_; }  ///< By zone; empty: all 1.
  /// Throws std::invalid_argument if they are not in (0,1], one for each zone, or none.
  void set_solid_shares(std::vector<float> shares);
  /// Unit, points away from the side the zone is on; of a group, the direction of the sum of its area
  /// vectors, or the normal of its first member where that is 0.
  Vec3 zone_normal(ZoneId z) const;
  /// Barycentric corners within the parent triangle; counter-clockwise seen from the *front* of the triangle.
  /// Pre: not a group.
  std::array<Barycentric, 3> zone_barycentrics(ZoneId z) const;
  Vec3 point(TriangleId t, double u, double v) const;  ///< [m], on the shape where it is curved.
  /// Barycentric position in t of a point on it [m].
  Barycentric barycentric_of(TriangleId t, const Vec3& point) const;
  Vec3 zone_centroid(ZoneId z) const;  ///< [m]; of a group, the mean over its area, holes of cut-outs too.

 private:
  static constexpr std::uint32_t kWhole = 0xffffffff;
  struct Side {
    ZoneId first_zone;
    std::uint32_t divisions;
    std::uint32_t nodes = kWhole;  // those of its cells start here; kWhole: none is cut further
  };
  /// A cell, or a part of one.
  struct Node {
    std::uint32_t at;   // zone within its side, or the first of its halves
    std::uint32_t cut;  // as in CellSplits
  };

  const Side& side(TriangleId t, bool front) const { return sides_[side_of(t, front).index()]; }
  std::size_t first_member(ZoneId group) const { return first_member_[group.index() - cell_zone_count()]; }
  double group_area(ZoneId group) const;  // with the holes of cut-outs [m2]
  SideCell member_cell(ZoneId group, float& u) const;
  /// Of a side with cells that are cut further.
  ZoneId zone_in_parts(const Side& side, float u, float v) const;

  void add_shapes();
  void check_backs() const;
  void add_cells();
  void add_split_cells(SideId side, std::size_t& next_cut);
  void add_node(SideId side, std::size_t node, const CellCorners& cell, std::size_t& next_cut);
  void add_groups();

  BaseMesh base_;
  std::size_t flat_count_ = 0;
  std::vector<CurvedPatches> curved_;
  std::vector<TriangleId> first_patch_;
  std::vector<double> triangle_area_;
  std::vector<Vec3> triangle_normal_;
  std::vector<Side> sides_;                // of one in a group: the group, 1
  std::vector<SideId> zone_side_;          // of each zone; of a group, its first member
  std::vector<CellCorners> zone_corners_;  // of each zone that is no group
  CellSplits splits_;
  std::vector<Node> nodes_;  // one at least, for lanes that need none
  ZoneGroups groups_;
  std::vector<std::size_t> first_member_;  // of each group, and the end
  std::vector<SideId> members_;            // by group
  std::vector<double> members_area_;       // of the members of a group up to and with this one [m2]
  std::vector<std::uint32_t> member_;      // by side; empty without groups
  std::vector<float> solid_shares_;
};

}  // namespace reemit
