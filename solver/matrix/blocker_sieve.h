#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "solver/matrix/polygon_form_factor.h"

namespace reemit {

/// What can be said without rays about the view between two zones.
enum class PairSight {
  kOpen,  ///< No base triangle can block the line between any two points.
  kUnknown,
  kHidden,  ///< One base triangle blocks all of them.
};

/// Settles most pairs of zones without rays. A base triangle can only block a pair that has points in front
/// of its plane and behind it; of those few, it must also reach in front of both zones and into the box
/// around them. It blocks all of a pair if it lies between them and all lines between their corners pierce
/// it: where other lines meet its plane lies in the convex hull of where these do.
class BlockerSieve {
 public:
  /// `tolerance` [m]: points nearer to a plane count as on it.
  BlockerSieve(const ZoneMesh& mesh, double tolerance);

  /// Between `pair.a`, a part of zone i, and `pair.b`, a part of zone j.
  PairSight look(std::size_t i, std::size_t j, const FacingPair& pair) const;

 private:
  bool may_block(TriangleId t, const FacingPair& pair) const;
  bool blocks_all(TriangleId t, const FacingPair& pair) const;

  const ZoneMesh* mesh_;
  double tolerance_;
  std::size_t words_;                 // of 64 triangles
  std::vector<std::uint64_t> front_;  // bit t of zone z: some corner lies in front of triangle t
  std::vector<std::uint64_t> behind_;
};

}  // namespace reemit
