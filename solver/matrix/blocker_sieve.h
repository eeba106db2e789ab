#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zone_mesh.h"
#include "solver/matrix/polygon_form_factor.h"

namespace reemit {

/// Proves for most pairs of zones that nothing can come between them. A base triangle can only block a pair
/// that has points in front of its plane and behind it; of those few, it must also reach in front of both
/// zones and into the box around them.
class BlockerSieve {
 public:
  /// `tolerance` [m]: points nearer to a plane count as on it.
  BlockerSieve(const ZoneMesh& mesh, double tolerance);

  /// False only if no base triangle can block the line between any point of `pair.a`, a part of zone i, and
  /// any point of `pair.b`, a part of zone j.
  bool may_be_blocked(std::size_t i, std::size_t j, const FacingPair& pair) const;

 private:
  bool may_block(std::size_t triangle, const FacingPair& pair) const;

  const ZoneMesh* mesh_;
  double tolerance_;
  std::size_t words_;                 // of 64 triangles
  std::vector<std::uint64_t> front_;  // bit t of zone z: some corner lies in front of triangle t
  std::vector<std::uint64_t> behind_;
};

}  // namespace reemit
