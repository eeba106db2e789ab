#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/overlap/hidden_lines.h"
#include "mesh/overlap/near_pieces.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"
#include "scenes/model/work_watch.h"

namespace reemit {

/// Pieces that lie in one plane and overlap, to be triangulated together; mostly a single piece.
struct PieceGroup {
  const PlaneFrame& plane;  ///< Of the largest piece.
  std::span<const std::uint32_t> pieces;
};

/// Most groups are a single piece of millions, so they share their lists. The pieces must outlive the groups.
struct PieceGroups {
  std::vector<std::uint32_t> pieces;     ///< Of one group after the other.
  std::vector<std::uint32_t> first;      ///< In `pieces`, by group, and one past the last.
  std::vector<const PlaneFrame*> plane;  ///< By group.
  std::vector<std::uint32_t> group_of;   ///< By piece.
  std::vector<std::uint32_t> crossings;  ///< Vertices where outlines of overlapping pieces cross in sight.
  HiddenLines hidden;

  std::size_t size() const { return plane.size(); }
  PieceGroup operator[](std::size_t g) const {
    return {*plane[g], std::span(pieces).subspan(first[g], first[g + 1] - first[g])};
  }
};

/// Bounding box of a piece, enlarged by `margin` [m] on all sides.
IndexedBox box_of(const VertexTable& vertices, const FacePiece& piece, std::size_t index, double margin);

/// Finds the pieces that overlap within the weld distance of one plane. Overlap narrower than a few weld
/// distances is not seen. Adds the crossings of outlines that are in sight to `vertices`. Throws InputError,
/// naming a face, if there are more than a million crossings or ten million pairs, and what LookLimit
/// throws.
PieceGroups group_overlapping_pieces(const Scene& scene, const std::vector<FacePiece>& pieces,
                                     const NearPieces& near, const MeshTolerances& tolerances,
                                     const WorkStep& step, VertexTable& vertices);

/// Which pieces keep a spot of their common plane.
struct Keepers {
  static constexpr std::size_t kNobody = ~std::size_t{0};
  std::size_t winner = kNobody;  ///< Has both sides, unless another has that behind its front.
  std::size_t back = kNobody;
};

/// Which of the pieces that cover a spot of their common plane keep it: `covering` in ascending order.
/// - Facing the same way, a luminaire wins, else the earlier piece.
/// - Facing each other, a luminaire wins too if it is an open sheet: it is there to shine, however the other
/// is wound.
/// - The side of a closed lamp that is pressed onto a one-sided surface cannot shine, so the surface stays.
/// Where the
///   surface is two-sided, its winding says nothing: the lamp wins if it shines towards the centre of the
///   room.
/// - Facing apart, both stay where may_be_back_to_back; what wins among those that face the same way is
/// asked.
Keepers keepers_of(const Scene& scene, const std::vector<FacePiece>& pieces,
                   const std::vector<std::size_t>& covering, const Vec3& room_centre);

}  // namespace reemit
