#pragma once
#include <cstddef>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/vertex_table.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/pieces/face_piece.h"
#include "mesh/pieces/loop_bins.h"

namespace reemit {

/// The pieces of a group in the coordinates of its plane, found by where they lie: a floor may share its
/// plane with the undersides of everything that stands on it. Pieces are numbered as in PieceGroup::pieces.
class GroupOutlines {
 public:
  GroupOutlines(const VertexTable& vertices, const std::vector<FacePiece>& pieces, const PieceGroup& group);

  const PlanarLoops& operator[](std::size_t k) const { return loops_[k]; }
  std::size_t size() const { return loops_.size(); }
  /// The pieces whose bounding rectangles touch the given one, in ascending order.
  void near(const Vec2& low, const Vec2& high, std::vector<std::size_t>& out) const;
  /// The pieces that contain a point, in ascending order.
  void covering(const Vec2& p, std::vector<std::size_t>& out) const;
  /// Any piece contains the point.
  bool cover(const Vec2& p) const;

 private:
  bool contains(std::size_t k, const Vec2& p) const;

  std::vector<PlanarLoops> loops_;
  std::vector<std::vector<LoopBins>> bins_;  // of pieces with long loops; else empty
  BoxTree tree_;                             // of more than one
};

}  // namespace reemit
