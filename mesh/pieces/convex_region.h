#pragma once
#include <array>
#include <cstddef>

#include "mesh/geometry/vertex_table.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/vec.h"

namespace reemit {

/// A box cut by slabs: where something must lie to touch a face or an edge. Its answers may be "perhaps"
/// where the truth is no, never the other way round.
class ConvexRegion {
 public:
  /// Around the straight edge from a to b, `reach` metres to all sides.
  static ConvexRegion of_edge(const Vec3& a, const Vec3& b, double reach);
  /// Of a piece in (about) `plane`: up to `reach` metres off the plane, and farther than `inset` metres
  /// inside every edge along which the piece ends (inset may be negative).
  static ConvexRegion of_piece(const VertexTable& vertices, const FacePiece& piece, const PlaneFrame& plane,
                               double reach, double inset);

  /// A box may reach into the region.
  bool touches(const Vec3& box_min, const Vec3& box_max) const {
    if ((box_min.array() > max_.array()).any() || (box_max.array() < min_.array()).any()) return false;
    const Vec3 centre = 0.5 * (box_min + box_max);
    const Vec3 half = 0.5 * (box_max - box_min);
    for (std::size_t i = 0; i < count_; ++i) {
      const Slab& s = slabs_[i];
      const double middle = s.normal.dot(centre);
      const double radius = s.normal.cwiseAbs().dot(half);
      if (middle - radius > s.high || middle + radius < s.low) return false;
    }
    return true;
  }
  /// The polygon with the corners [begin, end) may reach into the region; the box has been asked before.
  bool touches(const Vec3* begin, const Vec3* end) const;

 private:
  struct Slab {
    Vec3 normal;  // n.x is within [low, high]
    double low;
    double high;
  };
  static constexpr std::size_t kMostSlabs = 9;  // polygons with more edges are met by their first ones

  Vec3 min_;
  Vec3 max_;
  std::array<Slab, kMostSlabs> slabs_;
  std::size_t count_ = 0;
};

}  // namespace reemit
