#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zones/side.h"

namespace reemit {

/// Sides whose cells are cut further, where light differs: into four congruent parts, between the middles of
/// their edges, and these again. What is not cut further is a zone.
struct CellSplits {
  std::vector<SideId> sides;  ///< Ascending; none is in a group.
  /// For each of these sides and each of its cells in order (zone_lookup.h): 0, or 1 and then the same of its
  /// parts, those at the first, second and third corner and that in the middle.
  std::vector<std::uint8_t> is_split;
};

}  // namespace reemit
