#pragma once
#include <cstddef>

#include "scenes/model/ids.h"

namespace reemit {

/// A side of a base triangle. Tables by side hold two rows for each triangle, that of its front first.
using SideId = Id<struct SideTag>;

/// The side of a triangle and back.
constexpr SideId side_of(TriangleId t, bool front) {
  return SideId(2 * t.index() + (front ? 0 : 1));
}
constexpr TriangleId triangle_of(SideId side) {
  return TriangleId(side.index() / 2);
}
/// Else it is the back.
constexpr bool is_front(SideId side) {
  return side.index() % 2 == 0;
}
/// Rows of a table by side.
constexpr std::size_t side_count(std::size_t triangles) {
  return 2 * triangles;
}

}  // namespace reemit
