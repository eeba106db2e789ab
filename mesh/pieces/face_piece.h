#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "mesh/geometry/vertex_table.h"
#include "scenes/model/ids.h"
#include "scenes/model/vec.h"

namespace reemit {

using Vec2 = Eigen::Vector2d;
using Loop = std::vector<std::uint32_t>;  ///< Closed polygon: indices into the VertexTable.

/// A plane with coordinates in it. The axes and the normal are right-handed.
struct PlaneFrame {
  Vec3 origin{0, 0, 0};
  Vec3 u{1, 0, 0};
  Vec3 v{0, 1, 0};
  Vec3 normal{0, 0, 1};

  /// Frame of the plane through `origin` with unit `normal`.
  static PlaneFrame make(const Vec3& origin, const Vec3& normal);

  Vec2 project(const Vec3& p) const { return {u.dot(p - origin), v.dot(p - origin)}; }
  Vec3 lift(const Vec2& p) const { return origin + p.x() * u + p.y() * v; }
  double height(const Vec3& p) const { return normal.dot(p - origin); }  ///< Signed distance [m].
};

/// A planar polygon on its way from the input to base triangles: a face of the scene, or a triangle of a bent
/// one.
struct FacePiece {
  SurfaceId surface;
  std::uint32_t face = 0;  ///< In the surface.
  std::vector<Loop>
      loops;            ///< The first is the outline, counter-clockwise from the front; the rest are holes.
  PlaneFrame plane;     ///< Its normal points to the front.
  double diameter = 0;  ///< Diagonal of the bounding box [m].
  double area = 0;      ///< Net of holes, of the polygon as read [m2].
  bool smooth = false;  ///< Has shading normals; only triangles have.
  std::array<std::uint32_t, 3> corner;  ///< If smooth: the triangle the normals belong to, as vertices.
  std::array<Vec3, 3> corner_normal;    ///< If smooth: unit.
  bool two_sided = false;
  bool emits = false;
  bool emits_both_sides = false;
  bool in_closed_shell = false;   ///< Of its material: every edge has exactly two faces.
  bool outside_of_solid = false;  ///< In a closed shell that looks outwards.
  bool is_matt = false;  ///< Reflects diffusely and does nothing else with light, the same everywhere.

  bool is_triangle() const { return loops.size() == 1 && loops[0].size() == 3; }
  /// Turns the front to the other side.
  void flip();
  /// Interpolated shading normal at a point of the plane. Pre: smooth.
  Vec3 shading_normal(const VertexTable& vertices, const Vec3& p) const;
};

/// What the edge from a to b contributes to the winding number around p: +1 upwards left of p, -1 downwards.
inline int winding_of_edge(const Vec2& a, const Vec2& b, const Vec2& p) {
  if ((a.y() <= p.y()) == (b.y() <= p.y())) return 0;
  const double side = (b.x() - a.x()) * (p.y() - a.y()) - (p.x() - a.x()) * (b.y() - a.y());
  if (b.y() > a.y()) return side > 0 ? 1 : 0;
  return side < 0 ? -1 : 0;
}

/// Winding number of the loop around p: 0 outside, +1 inside of a counter-clockwise simple loop.
int winding_number(const std::vector<Vec2>& loop, const Vec2& p);

/// The loops of a piece in the coordinates of some plane.
struct PlanarLoops {
  std::vector<std::vector<Vec2>> loops;
  Vec2 min{0, 0};
  Vec2 max{0, 0};

  PlanarLoops() = default;
  PlanarLoops(const VertexTable& vertices, const FacePiece& piece, const PlaneFrame& plane);
  /// Inside the outline and in no hole; either winding. Outlines that cross themselves are filled.
  bool contains(const Vec2& p) const;
  /// Distance to the nearest edge [m].
  double distance_to_boundary(const Vec2& p) const;
};

/// Area of the part of the loops within a triangle, of either winding [m2]. Pre: no loop crosses itself.
double area_within(const PlanarLoops& loops, const std::array<Vec2, 3>& triangle);

}  // namespace reemit
