#pragma once
#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scenes/model/shape.h"

namespace reemit::validation {

/// Corners of a convex planar polygon, counter-clockwise seen from its front [m].
using Polygon = std::vector<Vec3>;
/// What a surface is made of: polygons, or one exact round shape.
using Body = std::variant<std::vector<Polygon>, CurvedShape>;

/// Rectangle or parallelogram whose front looks along u x v.
Polygon parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v);
/// The same polygon seen from behind.
Polygon flipped(const Polygon& polygon);
/// A triangle of about `size` whose centroid is the point and whose front looks along `normal`.
Polygon triangle_around(const Vec3& point, const Vec3& normal, double size);
/// The polygon, turned over if its front looks away from the point.
Polygon turned_towards(const Polygon& polygon, const Vec3& point);
/// Axis-parallel rectangle across axis `axis` at `height`, over [a0,a1] x [b0,b1] of the two other axes in
/// the order x, y, z; the front looks up or down the axis.
Polygon axis_rectangle(int axis, double height, double a0, double a1, double b0, double b1, bool up);
/// The rectangle above cut into nx x ny equal parts.
std::vector<Polygon> axis_grid(int axis, double height, double a0, double a1, double b0, double b1, bool up,
                               int na, int nb);

/// Names of the faces of a box: planes x=0, x=X, y=0, ...
inline constexpr std::array<const char*, 6> kBoxFaces{"x0", "x1", "y0", "y1", "z0", "z1"};
/// Face `face` (0-5, order of kBoxFaces) of the box [0,size], looking inward.
Polygon box_face(int face, const Vec3& size);

/// Icosahedron cut `subdivisions` times, new corners pushed out to the unit sphere. Fronts look out. The
/// first of the four parts of a triangle is the one at its first corner.
std::vector<Polygon> unit_icosphere(int subdivisions);
double total_area(const std::vector<Polygon>& polygons);
/// Side of a prism of the lateral area of the cylinder. `axis`: from base to top [m].
std::vector<Polygon> cylinder_side(const Vec3& base, const Vec3& axis, double radius, int sides, bool inward);
/// Base or top that fits the prism: the regular polygon of its perimeter.
std::vector<Polygon> cylinder_cap(const Vec3& centre, const Vec3& normal, double radius, int sides);

/// The inside of a closed cylinder about the z axis: base at z = 0, top and side.
std::vector<std::pair<std::string, Body>> closed_cylinder(double radius, double height);

/// A room of the plan [0,x_arm] x [0,1] and [0,1] x [0,y_arm] with height `height`: faces by name, inward.
/// W1 y=0, W2 x=x_arm, W3 y=1, W4 x=1, W5 y=y_arm, W6 x=0, F floor, C ceiling, each cut into squares of side
/// 1/zones_per_metre.
std::vector<std::pair<std::string, std::vector<Polygon>>> l_room(double x_arm, double y_arm, double height,
                                                                 int zones_per_metre);

}  // namespace reemit::validation
