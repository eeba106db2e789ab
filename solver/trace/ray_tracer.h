#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "solver/texture/room_textures.h"
#include "solver/trace/flat_hits.h"
#include "solver/trace/patch_chord.h"
#include "solver/trace/ray16.h"
#include "solver/trace/shape_feet.h"

namespace reemit {

class EmbreeTree;

/// Where a ray met the room.
struct Hit {
  TriangleId triangle;
  float u = 0;  ///< Barycentric, as ZoneMesh::point.
  float v = 0;
  float distance = 0;  ///< In normalised units (RayTracer::metres_per_unit).
  bool front = true;   ///< The ray came from the front of the triangle.
};

/// Owner of the ray-tracing structure over the base triangles and curved shapes. Rays live in a normalised
/// space in which the room fits into [-1,1]^3, so that rooms of any size and place behave alike. Const
/// members may be called from any thread.
class RayTracer {
 public:
  static constexpr std::uint32_t kMiss = 0xffffffff;
  /// Distance by which rays start off their surface [normalised units]: some 16 roundings of a coordinate
  /// near 1.
  static constexpr float kLift = 1e-6F;
  /// How far of the way to the middle of its triangle, `distance` away, a ray start is drawn: 4 kLift in all,
  /// which keeps the lifted point inside rooms whose corners are as sharp as atan(1/4) = 14 degrees.
  static float inset_share(float distance) {
    return 4 * kLift / (distance > 4 * kLift ? distance : 4 * kLift);
  }

  explicit RayTracer(const ZoneMesh& mesh);
  /// With the cut-outs of a room, which must outlive it: rays pass through a point of one with the share of
  /// it that is not there, by a number that depends on the ray and the triangle alone.
  RayTracer(const ZoneMesh& mesh, const RoomTextures& textures);
  ~RayTracer();
  RayTracer(RayTracer&&) noexcept;
  RayTracer& operator=(RayTracer&&) noexcept;

  double metres_per_unit() const { return metres_per_unit_; }
  const Vec3& centre() const { return centre_; }  ///< The origin of the normalised space [m].
  Vec3 normalised_double(const Vec3& point) const { return (point - centre_) / metres_per_unit_; }
  Vec3f normalised(const Vec3& point) const { return normalised_double(point).cast<float>(); }
  CurvedShape normalised(const CurvedShape& shape) const;
  Vec3 in_room(const Vec3f& point) const { return point.cast<double>() * metres_per_unit_ + centre_; }

  Vec3f corner(TriangleId t, int k) const { return corners_[3 * t.index() + static_cast<std::size_t>(k)]; }
  /// Unit normal of the front of a flat triangle, or in the middle of a curved patch.
  const Vec3f& normal(TriangleId t) const { return faces_[t.index()].normal; }
  /// Unit normal of the front at (u,v).
  Vec3f normal(TriangleId t, float u, float v) const {
    return is_curved(t) ? curved_normal(t, u, v) : normal(t);
  }
  bool is_curved(TriangleId t) const { return t.index() >= flat_count_; }
  Vec3f point(TriangleId t, float u, float v) const {
    if (is_curved(t)) return curved_point(t, u, v).cast<float>();
    return (1 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2);
  }
  PatchChord patch_chord(TriangleId t) const {
    return {{corner(t, 0), corner(t, 1), corner(t, 2)}, patch_middles_[t.index() - flat_count_]};
  }
  /// Barycentric coordinates of the middle of a patch.
  static constexpr float kMiddle = 1.0F / 3;
  /// Whether other faces touch the shape of a patch, so that rays start clear of them.
  bool touches_others(TriangleId t) const { return feet_.touches_others(shape_of(t)); }
  /// The curved shape that a patch belongs to, in the normalised space.
  const CurvedPatches& patches(TriangleId t) const { return shapes_[shape_of(t)]; }
  /// The one self-intersection rule of the program: start of a ray that leaves a triangle with centroid
  /// `middle` at `point` on the side that `side_normal` (unit) points to.
  static Vec3f lifted(const Vec3f& point, const Vec3f& side_normal, const Vec3f& middle);
  /// Moves (u,v) off the edges of a flat triangle that are nearer than edge_share() says, by 4 kLift within
  /// the triangle. `lifted` draws starts towards the middle, which on a sliver leads along its long edges: a
  /// point on such an edge would stay in the plane of the face that the sliver ends at, and the ray start
  /// beyond it.
  void move_off_edges(TriangleId t, float& u, float& v) const;
  /// Whether a curved shape stands on a flat triangle, so that rays start clear_of_shapes (ShapeFeet).
  bool is_foot(TriangleId t) const { return feet_.is_foot_at(t.index()); }
  Vec3f clear_of_shapes(TriangleId t, const Vec3f& start) const {
    return feet_.clear_of_shapes(t.index(), start);
  }
  /// True if a ray that leaves a side of a flat triangle there starts on the other side, because rounding
  /// took more than the lift. Never of curved patches.
  bool starts_behind(TriangleId t, bool front, const Vec3f& start) const {
    if (is_curved(t)) return false;
    const float height = normal(t).dot(start - corner(t, 0));
    return (front ? height : -height) < 0;
  }
  /// Start of a ray that leaves the given side at (u,v).
  Vec3f ray_origin(TriangleId t, float u, float v, bool front) const {
    Vec3f normal;
    return ray_origin(t, u, v, front, normal);
  }
  /// Also tells the unit normal of the front there; on curved shapes within 4 kLift of it, for less.
  Vec3f ray_origin(TriangleId t, float u, float v, bool front, Vec3f& front_normal) const;

  /// Nearest hit along a ray of unit direction, after a second look if needed. False if there is none.
  /// `chance`, here and below: what decides at cut-outs beside origin and direction, for rays that are sent
  /// between the same places again and again.
  bool closest(const Vec3f& origin, const Vec3f& direction, Hit& hit, std::uint32_t chance = 0) const;
  /// Nearest hit that is not the back of a one-sided triangle: what a camera sees.
  bool closest_for_camera(const Vec3f& origin, const Vec3f& direction, Hit& hit) const;
  /// Nearest hits of the first `count` <= 16 rays. The caller looks twice, with look_again16 or full blocks.
  void closest16(const Ray16& rays, int count, Hit16& hits) const;
  /// True if a ray that ended so deserves a second look: at a back, an edge or what may be a hairline.
  bool is_doubtful(std::uint32_t triangle, float u, float v, bool front) const {
    return !has_left(triangle) && (is_lost(triangle, front) || is_at_edge(triangle, u, v));
  }
  /// True if a ray that met this, or nothing, has left the room: it cannot have slipped through a hairline,
  /// or would be lost among those that leave (believe_misses).
  bool has_left(std::uint32_t triangle) const {
    return triangle == kMiss && (!misses_are_doubtful_ || misses_are_believed_);
  }
  /// For rooms that much light leaves: hairlines take less than a millionth of the rays, so that a second
  /// look at each that meets nothing changes nothing that could be measured. Cameras and `escapes` look all
  /// the same. Not to be called while others trace.
  void believe_misses() { misses_are_believed_ = true; }
  /// True if (u,v) is so near an edge of a flat triangle that rounding decides which of the faces that meet
  /// there a ray seems to meet first.
  bool is_at_edge(std::uint32_t triangle, float u, float v) const {
    return std::min({u, v, 1 - u - v}) < faces_[triangle].edge_share && edges_near(triangle, u, v) != 0;
  }
  bool is_at_edge(const Hit16& hits, int lane) const {
    return hits.near_edge[lane] && edges_near(hits.triangle[lane], hits.u[lane], hits.v[lane]) != 0;
  }
  /// Smallest barycentric coordinate below which a point of the triangle may be at an edge; nothing is below
  /// that of a curved patch.
  float edge_share(TriangleId t) const { return faces_[t.index()].edge_share; }
  /// Second look at the doubtful ones of `hits`.
  void look_again16(const Ray16& rays, int count, Hit16& hits) const;
  /// Direction of the second look at a ray that ended so; (u,v) say nothing if it met nothing. A ray that
  /// meets nothing may have slipped through a hairline where triangles with different vertices meet, and
  /// one that meets a back through another to get there. One that meets an edge may have passed another face
  /// there: seen from outside, the near and the far face of a box are equally far at its rim, and where
  /// rounding prefers the far one, light comes to the inside of a closed box. All are traced once more,
  /// turned by a few millionths, at edges towards the inside of the triangle: what they meet then is true.
  Vec3f second_direction(const Vec3f& direction, std::uint32_t triangle, float u, float v) const;
  Vec3f second_direction(const Vec3f& direction, const Hit16& hits, int lane) const {
    return second_direction(direction, hits.triangle[lane], hits.u[lane], hits.v[lane]);
  }
  /// What decides whether a ray passes cut-outs, for its second look to decide alike; 0 in rooms without.
  std::uint32_t cut_out_key(const Vec3f& origin, const Vec3f& direction, std::uint32_t chance = 0) const {
    return cut_outs_ == nullptr ? 0 : key_of(origin, direction, chance);
  }
  std::uint32_t cut_out_key(const Ray16& rays, int lane) const {
    if (cut_outs_ == nullptr) return 0;
    return rays.key[lane] != 0 ? rays.key[lane] : key_of(rays.origin(lane), rays.direction(lane), 0);
  }
  /// Nearest hit on the way to a ray origin at this distance along a unit direction, without a second look,
  /// as `visible` has it. False if there is none.
  bool first_on_way(const Vec3f& origin, const Vec3f& direction, float distance, Hit& hit,
                    std::uint32_t chance = 0) const;
  /// True if nothing lies between two ray origins (made by ray_origin, or free points such as a lamp or an
  /// eye).
  bool visible(const Vec3f& from, const Vec3f& to, std::uint32_t chance = 0) const;
  /// True if a ray of unit direction leaves the room without a hit.
  bool escapes(const Vec3f& origin, const Vec3f& direction, std::uint32_t chance = 0) const;

  const ZoneMesh& mesh() const { return *mesh_; }

 private:
  std::uint32_t shape_of(TriangleId t) const { return mesh_->triangle(t).shape; }
  static std::uint32_t key_of(const Vec3f& origin, const Vec3f& direction, std::uint32_t chance);
  Vec3 curved_point(TriangleId t, float u, float v) const;
  Vec3f curved_normal(TriangleId t, float u, float v) const;
  Vec3f curved_ray_origin(TriangleId t, float u, float v, bool front, Vec3f& front_normal) const;
  bool is_lost(std::uint32_t triangle, bool front) const {
    return triangle == kMiss || !mesh_->has_zones(TriangleId(triangle), front);
  }
  /// Edges within kEdgeWidth of (u,v), as bits: bit k is the edge opposite to corner k.
  unsigned edges_near(std::uint32_t triangle, float u, float v) const;
  Vec3f into_triangle(TriangleId t, int corner, float& height) const;
  /// Nearest hit before `far`, without a second look.
  bool nearest(const Vec3f& origin, const Vec3f& direction, float far, std::uint32_t key, Hit& hit) const;
  /// Returns the cosine between the direction and the normal of the front.
  float read_hit(std::uint32_t geometry, std::uint32_t primitive, float u, float v, float distance,
                 const Vec3f& origin, const Vec3f& direction, Hit& hit) const;

  const ZoneMesh* mesh_;
  const RoomTextures* cut_outs_ = nullptr;  // null where the room has none
  double metres_per_unit_ = 1;
  Vec3 centre_{0, 0, 0};
  std::vector<Vec3f> corners_;
  std::vector<FacePlane> faces_;  // one at least
  std::size_t flat_count_ = 0;
  bool misses_are_doubtful_ = true;  // there may be hairlines (may_have_hairlines)
  bool misses_are_believed_ = false;
  std::vector<CurvedPatches> shapes_;  // normalised, as BaseMesh::shapes
  std::vector<Vec3f> patch_middles_;   // of curved patches
  ShapeFeet feet_;
  std::unique_ptr<EmbreeTree> embree_;
};

}  // namespace reemit
