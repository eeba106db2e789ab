#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Where outlines run under other pieces of their plane. A piece loses to those that hide it on both sides of
/// such a line, so nothing changes there and nothing needs to be cut. Without this, a stack of many faces is
/// cut along all crossings of all of them, which nobody sees.
class HiddenLines {
 public:
  HiddenLines() = default;
  explicit HiddenLines(const MeshTolerances& tolerances) : weld_(tolerances.weld) {}

  /// Finds what the `hiders`, pieces that overlap `piece` and win against it wherever they cover it, hide of
  /// its outline.
  void find(const VertexTable& vertices, const std::vector<FacePiece>& pieces, std::uint32_t piece,
            std::span<const std::uint32_t> hiders);

  /// A part of the outline is hidden.
  bool any(std::size_t piece) const { return stretches_.contains(static_cast<std::uint32_t>(piece)); }
  /// A point on the outline is hidden, clear of where it comes out.
  bool hide(std::size_t piece, const Vec3& p) const { return hide(piece, p, p, -margin()); }
  /// All of a straight part of the outline is hidden.
  bool hide(std::size_t piece, const Vec3& a, const Vec3& b) const { return hide(piece, a, b, margin()); }

 private:
  struct Stretch {
    Vec3 from;
    Vec3 direction;  // unit
    double length;
  };
  /// Welding moves the ends of a stretch.
  double margin() const { return 4 * weld_; }
  bool hide(std::size_t piece, const Vec3& a, const Vec3& b, double slack) const;

  double weld_ = 0;
  std::unordered_map<std::uint32_t, std::vector<Stretch>> stretches_;  // by piece; most pieces have none
};

}  // namespace reemit
