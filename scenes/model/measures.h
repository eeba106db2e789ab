#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

inline double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

/// Area times unit normal of a closed loop (Newell's sum): exact for planar loops, the mean for others; 0 for
/// less than three corners. The front is where corners run counter-clockwise; `place` tells where one is.
template <class Corners, class Place>
Vec3 loop_area(const Corners& loop, const Place& place) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3& origin = place(loop[0]);  // keeps the products small far from the room's origin
    twice += (place(loop[i]) - origin).cross(place(loop[i + 1]) - origin);
  }
  return 0.5 * twice;
}

inline Vec3 loop_area(const std::vector<Vec3>& loop) {
  return loop_area(loop, std::identity());
}

/// Of a loop of indices into a list of positions.
template <class Positions>
Vec3 outline_area(const Positions& positions, const std::vector<std::uint32_t>& outline) {
  return loop_area(outline, [&](std::uint32_t i) -> const Vec3& { return positions[i]; });
}

/// In the plane or in space; the ends may be the same point.
template <class Point>
double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along - p).squaredNorm();
}

}  // namespace reemit
