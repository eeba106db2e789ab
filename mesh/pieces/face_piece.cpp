#include "mesh/pieces/face_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "scenes/model/measures.h"

namespace reemit {

PlaneFrame PlaneFrame::make(const Vec3& origin, const Vec3& normal) {
  // Axis-aligned planes get axis-aligned coordinates, so that projecting them does not round.
  Eigen::Index smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  const Vec3 axis = Vec3::Unit(smallest);
  const Vec3 u = (axis - axis.dot(normal) * normal).normalized();
  return {.origin = origin, .u = u, .v = normal.cross(u), .normal = normal};
}

void FacePiece::flip() {
  for (Loop& loop : loops) std::reverse(loop.begin(), loop.end());
  plane = PlaneFrame::make(plane.origin, -plane.normal);
  for (Vec3& n : corner_normal) n = -n;
}

Vec3 FacePiece::shading_normal(const VertexTable& vertices, const Vec3& p) const {
  const Vec3& a = vertices[corner[0]];
  const Vec3 e1 = vertices[corner[1]] - a;
  const Vec3 e2 = vertices[corner[2]] - a;
  const Vec3 n = e1.cross(e2);
  const double scale = 1 / n.squaredNorm();
  const double u = n.dot((p - a).cross(e2)) * scale;
  const double v = n.dot(e1.cross(p - a)) * scale;
  const Vec3 sum = (1 - u - v) * corner_normal[0] + u * corner_normal[1] + v * corner_normal[2];
  const double length = sum.norm();
  return length > 1e-6 ? Vec3(sum / length) : plane.normal;
}

int winding_number(const std::vector<Vec2>& loop, const Vec2& p) {
  int winding = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    winding += winding_of_edge(loop[i], loop[(i + 1) % loop.size()], p);
  return winding;
}

PlanarLoops::PlanarLoops(const VertexTable& vertices, const FacePiece& piece, const PlaneFrame& plane) {
  min = Vec2::Constant(std::numeric_limits<double>::infinity());
  max = -min;
  loops.reserve(piece.loops.size());
  for (const Loop& loop : piece.loops) {
    std::vector<Vec2>& out = loops.emplace_back();
    out.reserve(loop.size());
    for (const std::uint32_t v : loop) {
      out.push_back(plane.project(vertices[v]));
      min = min.cwiseMin(out.back());
      max = max.cwiseMax(out.back());
    }
  }
}

bool PlanarLoops::contains(const Vec2& p) const {
  if ((p.array() < min.array()).any() || (p.array() > max.array()).any()) return false;
  if (winding_number(loops[0], p) == 0) return false;
  return std::none_of(loops.begin() + 1, loops.end(),
                      [&](const std::vector<Vec2>& hole) { return winding_number(hole, p) != 0; });
}

double PlanarLoops::distance_to_boundary(const Vec2& p) const {
  double best = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec2>& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i)
      best = std::min(best, squared_distance_to_segment(p, loop[i], loop[(i + 1) % loop.size()]));
  return std::sqrt(best);
}

double area_within(const PlanarLoops& loops, const std::array<Vec2, 3>& triangle) {
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  const double winding = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]) < 0 ? -1 : 1;
  std::vector<Vec2> rest;
  std::vector<Vec2> clipped;
  double area = 0;
  for (std::size_t l = 0; l < loops.loops.size(); ++l) {
    // Sutherland and Hodgman: what lies beyond a side is folded onto its line, where it encloses nothing.
    rest = loops.loops[l];
    for (std::size_t k = 0; k < 3 && !rest.empty(); ++k) {
      const Vec2& a = triangle[k];
      const Vec2 along = triangle[(k + 1) % 3] - a;
      clipped.clear();
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const Vec2& p = rest[i];
        const Vec2& q = rest[(i + 1) % rest.size()];
        const double from = winding * cross(along, p - a);
        const double to = winding * cross(along, q - a);
        if (from >= 0) clipped.push_back(p);
        if ((from >= 0) != (to >= 0)) clipped.push_back(p + from / (from - to) * (q - p));
      }
      rest.swap(clipped);
    }
    double twice = 0;
    for (std::size_t i = 1; i + 1 < rest.size(); ++i)
      twice += cross(rest[i] - rest[0], rest[i + 1] - rest[0]);
    area += (l == 0 ? 0.5 : -0.5) * std::abs(twice);
  }
  return area;
}

}  // namespace reemit
