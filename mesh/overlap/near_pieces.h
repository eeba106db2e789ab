#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/vertex_table.h"
#include "mesh/pieces/convex_region.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Finds the pieces that may reach into a region: their boxes in a tree, and their corners side by side,
/// because most of what a box admits is rejected by a look at three corners.
class NearPieces {
 public:
  NearPieces(const Scene& scene, const VertexTable& vertices, const std::vector<FacePiece>& pieces);

  /// Calls `visit(index)` for pieces that may reach into the region around `asker`, in any order. Throws
  /// InputError naming the asker once there have been so many rejections that the room is quadratic:
  /// thousands of thin triangles that meet in one corner.
  template <class Visit>
  void visit(const ConvexRegion& region, std::size_t asker, const Visit& visit) {
    tree_.visit([&](const Vec3& low, const Vec3& high) { return region.touches(low, high); },
                [&](std::uint32_t i) {
                  ++looks_;
                  if (region.touches(corners_.data() + first_[i], corners_.data() + first_[i + 1])) visit(i);
                });
    if (looks_ > most_looks_) refuse(asker);
  }

 private:
  [[noreturn]] void refuse(std::size_t asker) const;

  const Scene& scene_;
  const std::vector<FacePiece>& pieces_;
  BoxTree tree_;
  std::vector<std::size_t> first_;  // corner of the outline, by piece, and one past the last
  std::vector<Vec3> corners_;
  std::size_t looks_ = 0;
  std::size_t most_looks_;
};

}  // namespace reemit
