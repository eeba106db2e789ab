#pragma once
#include <cstddef>
#include <cstdint>

#include "mesh/geometry/box_tree.h"
#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Box around a rectangle of a plane, for a BoxTree.
inline IndexedBox box_in_plane(const Vec2& low, const Vec2& high, std::size_t index) {
  return {{low.x(), low.y(), 0}, {high.x(), high.y(), 0}, static_cast<std::uint32_t>(index)};
}

/// Admits boxes in a plane that touch a rectangle of it.
class NearRectangle {
 public:
  NearRectangle(const Vec2& low, const Vec2& high) : low_(low), high_(high) {}
  bool operator()(const Vec3& min, const Vec3& max) const {
    return min.x() <= high_.x() && min.y() <= high_.y() && max.x() >= low_.x() && max.y() >= low_.y();
  }

 private:
  Vec2 low_;
  Vec2 high_;
};

}  // namespace reemit
