#include "solver/matrix/convex_polygon.h"

namespace reemit {

Vec3 ConvexPolygon::middle() const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) sum += corner[k];
  return sum / static_cast<double>(count);
}

double ConvexPolygon::area() const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 2; k < count; ++k) sum += (corner[k - 1] - corner[0]).cross(corner[k] - corner[0]);
  return 0.5 * sum.norm();
}

ConvexPolygon part_in_front(const ConvexPolygon& polygon, const Vec3& point, const Vec3& normal,
                            double tolerance) {
  std::array<double, ConvexPolygon::kMostCorners> height{};
  bool any_in_front = false;
  bool any_behind = false;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    height[k] = normal.dot(polygon.corner[k] - point);
    any_in_front = any_in_front || height[k] > tolerance;
    any_behind = any_behind || height[k] < -tolerance;
  }
  ConvexPolygon part;
  part.normal = polygon.normal;
  if (!any_in_front) return part;
  if (!any_behind) return polygon;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const std::size_t next = (k + 1) % polygon.count;
    if (height[k] >= -tolerance) part.add(polygon.corner[k]);
    const bool leaves = height[k] > tolerance && height[next] < -tolerance;
    const bool enters = height[k] < -tolerance && height[next] > tolerance;
    if (leaves || enters)
      part.add(polygon.corner[k] +
               height[k] / (height[k] - height[next]) * (polygon.corner[next] - polygon.corner[k]));
  }
  if (part.count < 3) part.count = 0;
  return part;
}

}  // namespace reemit
