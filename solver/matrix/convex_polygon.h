#pragma once
#include <array>
#include <cstddef>

#include "scenes/model/vec.h"

namespace reemit {

/// A planar convex polygon of up to five corners [m]: a zone, or what clipping leaves of one.
struct ConvexPolygon {
  static constexpr std::size_t kMostCorners = 5;
  std::array<Vec3, kMostCorners> corner;
  std::size_t count = 0;  ///< 0: nothing left; else at least 3.
  Vec3 normal{0, 0, 1};   ///< Unit; the corners run counter-clockwise seen from where it points.

  void add(const Vec3& p) { corner[count++] = p; }
  Vec3 middle() const;  ///< Mean of the corners. Pre: count > 0.
  double area() const;  ///< [m2]
};

/// Part of `polygon` that lies in front of the plane through `point` with unit normal `normal`. Corners
/// nearer to the plane than `tolerance` [m] count as on it; a polygon without a corner farther in front is
/// hidden from the plane: count 0. Pre: polygon.count < kMostCorners.
ConvexPolygon part_in_front(const ConvexPolygon& polygon, const Vec3& point, const Vec3& normal,
                            double tolerance);

}  // namespace reemit
