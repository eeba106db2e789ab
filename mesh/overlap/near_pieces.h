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
  NearPieces(const VertexTable& vertices, const std::vector<FacePiece>& pieces);

  /// Calls `visit(index)` for pieces that may reach into the region, in any order. Returns how many it had to
  /// look at.
  template <class Visit>
  std::size_t visit(const ConvexRegion& region, const Visit& visit) const {
    std::size_t looks = 0;
    tree_.visit([&](const Vec3& low, const Vec3& high) { return region.touches(low, high); },
                [&](std::uint32_t i) {
                  ++looks;
                  if (region.touches(corners_.data() + first_[i], corners_.data() + first_[i + 1])) visit(i);
                });
    return looks;
  }

 private:
  BoxTree tree_;
  std::vector<std::size_t> first_;  // corner of the outline, by piece, and one past the last
  std::vector<Vec3> corners_;
};

/// Ends searches by NearPieces in rooms that are quadratic: thousands of thin triangles that meet in one
/// corner.
class LookLimit {
 public:
  LookLimit(const Scene& scene, const std::vector<FacePiece>& pieces);

  /// Looks that one piece took. Throws InputError naming it once there have been too many.
  void add(std::size_t piece, std::size_t looks) {
    looks_ += looks;
    if (looks_ > most_looks_) refuse(piece);
  }

 private:
  [[noreturn]] void refuse(std::size_t piece) const;

  const Scene& scene_;
  const std::vector<FacePiece>& pieces_;
  std::size_t looks_ = 0;
  std::size_t most_looks_;
};

}  // namespace reemit
