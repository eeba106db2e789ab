#include "bench/validation/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reemit::validation {
namespace {

using std::numbers::pi;

Vec3 any_normal_to(const Vec3& axis) {
  const Vec3 helper = std::fabs(axis.x()) < 0.5 * axis.norm() ? Vec3::UnitX() : Vec3::UnitY();
  return axis.cross(helper).normalized();
}

/// Corners of a regular polygon about `axis`.
std::vector<Vec3> ring(const Vec3& centre, const Vec3& axis, double corner_radius, int sides) {
  const Vec3 u = any_normal_to(axis);
  const Vec3 v = axis.normalized().cross(u);
  std::vector<Vec3> points;
  for (int i = 0; i < sides; ++i) {
    const double phi = 2 * pi * i / sides;
    points.push_back(centre + corner_radius * (std::cos(phi) * u + std::sin(phi) * v));
  }
  return points;
}

std::vector<Polygon> fan(const Vec3& centre, const std::vector<Vec3>& rim) {
  std::vector<Polygon> parts;
  for (std::size_t i = 0; i < rim.size(); ++i) parts.push_back({centre, rim[i], rim[(i + 1) % rim.size()]});
  return parts;
}

/// Corner radius of the regular polygon of the circle's perimeter.
double radius_of_same_perimeter(double radius, int sides) {
  return radius * (pi / sides) / std::sin(pi / sides);
}

}  // namespace

Polygon parallelogram(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {corner, corner + u, corner + u + v, corner + v};
}

Polygon flipped(const Polygon& polygon) {
  return {polygon.rbegin(), polygon.rend()};
}

Polygon triangle_around(const Vec3& point, const Vec3& normal, double size) {
  const Vec3 n = normal.normalized();
  const Vec3 u = n.unitOrthogonal();
  const Vec3 v = n.cross(u);
  return {point + size * u, point + size * (-0.5 * u + v), point + size * (-0.5 * u - v)};
}

Polygon turned_towards(const Polygon& polygon, const Vec3& point) {
  const Vec3 normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
  return normal.dot(point - polygon[0]) < 0 ? flipped(polygon) : polygon;
}

Polygon axis_rectangle(int axis, double height, double a0, double a1, double b0, double b1, bool up) {
  const int a = axis == 0 ? 1 : 0;
  const int b = axis == 2 ? 1 : 2;
  const auto at = [&](double s, double t) {
    Vec3 p;
    p[axis] = height;
    p[a] = s;
    p[b] = t;
    return p;
  };
  // (a,b) is right-handed about +x and +z, left-handed about +y.
  Polygon p{at(a0, b0), at(a1, b0), at(a1, b1), at(a0, b1)};
  // Keeps the first corner and so the diagonal from (a0,b0) to (a1,b1) that fans cut along.
  if (up != (axis != 1)) std::swap(p[1], p[3]);
  return p;
}

std::vector<Polygon> axis_grid(int axis, double height, double a0, double a1, double b0, double b1, bool up,
                               int na, int nb) {
  std::vector<Polygon> cells;
  const auto at = [](double low, double high, int i, int n) {
    return i == n ? high : low + (high - low) * i / n;
  };
  for (int i = 0; i < na; ++i)
    for (int j = 0; j < nb; ++j)
      cells.push_back(axis_rectangle(axis, height, at(a0, a1, i, na), at(a0, a1, i + 1, na),
                                     at(b0, b1, j, nb), at(b0, b1, j + 1, nb), up));
  return cells;
}

Polygon box_face(int face, const Vec3& size) {
  const int axis = face / 2;
  const bool high = face % 2 != 0;
  const int a = axis == 0 ? 1 : 0;
  const int b = axis == 2 ? 1 : 2;
  return axis_rectangle(axis, high ? size[axis] : 0, 0, size[a], 0, size[b], !high);
}

std::vector<Polygon> unit_icosphere(int subdivisions) {
  const double g = std::numbers::phi;
  const std::array<Vec3, 12> p{{{-1, g, 0},
                                {1, g, 0},
                                {-1, -g, 0},
                                {1, -g, 0},
                                {0, -1, g},
                                {0, 1, g},
                                {0, -1, -g},
                                {0, 1, -g},
                                {g, 0, -1},
                                {g, 0, 1},
                                {-g, 0, -1},
                                {-g, 0, 1}}};
  constexpr std::array<std::array<std::size_t, 3>, 20> kFaces{
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  std::vector<Polygon> triangles;
  for (const auto& f : kFaces)
    triangles.push_back({p[f[0]].normalized(), p[f[1]].normalized(), p[f[2]].normalized()});
  for (int s = 0; s < subdivisions; ++s) {
    std::vector<Polygon> finer;
    for (const Polygon& t : triangles) {
      // Normalised sums do not depend on the order of the two corners: neighbours share bits.
      const Vec3 ab = (t[0] + t[1]).normalized();
      const Vec3 bc = (t[1] + t[2]).normalized();
      const Vec3 ca = (t[2] + t[0]).normalized();
      finer.push_back({t[0], ab, ca});
      finer.push_back({t[1], bc, ab});
      finer.push_back({t[2], ca, bc});
      finer.push_back({ab, bc, ca});
    }
    triangles = std::move(finer);
  }
  return triangles;
}

double total_area(const std::vector<Polygon>& polygons) {
  double area = 0;
  for (const Polygon& p : polygons)
    for (std::size_t i = 2; i < p.size(); ++i) area += 0.5 * (p[i - 1] - p[0]).cross(p[i] - p[0]).norm();
  return area;
}

std::vector<Polygon> cylinder_cap(const Vec3& centre, const Vec3& normal, double radius, int sides) {
  return fan(centre, ring(centre, normal, radius_of_same_perimeter(radius, sides), sides));
}

std::vector<Polygon> cylinder_side(const Vec3& base, const Vec3& axis, double radius, int sides,
                                   bool inward) {
  const std::vector<Vec3> rim = ring(base, axis, radius_of_same_perimeter(radius, sides), sides);
  std::vector<Polygon> quads;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3& a = rim[i];
    const Vec3& b = rim[(i + 1) % rim.size()];
    const Polygon quad{a, b, b + axis, a + axis};
    quads.push_back(inward ? flipped(quad) : quad);
  }
  return quads;
}

std::vector<std::pair<std::string, Body>> closed_cylinder(double radius, double height) {
  return {{"base", Disk{{0, 0, 0}, {0, 0, 1}, radius, 0}},
          {"top", Disk{{0, 0, height}, {0, 0, -1}, radius, 0}},
          {"lateral", Cylinder{{0, 0, 0}, {0, 0, height}, radius, true}}};
}

std::vector<std::pair<std::string, std::vector<Polygon>>> l_room(double x_arm, double y_arm, double height,
                                                                 int n) {
  const auto cells = [n](double length) { return std::max(1, static_cast<int>(std::lround(length * n))); };
  const auto wall = [&](int axis, double at, double from, double to, bool up) {
    return axis_grid(axis, at, from, to, 0, height, up, cells(to - from), cells(height));
  };
  const auto level = [&](double z, bool up) {
    std::vector<Polygon> all = axis_grid(2, z, 0, 1, 0, 1, up, n, n);
    for (const auto& part : {axis_grid(2, z, 1, x_arm, 0, 1, up, cells(x_arm - 1), n),
                             axis_grid(2, z, 0, 1, 1, y_arm, up, n, cells(y_arm - 1))})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  return {{"W1", wall(1, 0, 0, x_arm, true)},
          {"W2", wall(0, x_arm, 0, 1, false)},
          {"W3", wall(1, 1, 1, x_arm, false)},
          {"W4", wall(0, 1, 1, y_arm, false)},
          {"W5", wall(1, y_arm, 0, 1, false)},
          {"W6", wall(0, 0, 0, y_arm, true)},
          {"F", level(0, true)},
          {"C", level(height, false)}};
}

}  // namespace reemit::validation
