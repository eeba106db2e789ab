#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zones/side.h"

namespace reemit {

/// Sides whose cells are cut further, where light differs: from a corner to the middle of the edge opposite
/// it (cell_corners.h), and their halves again. What is not cut further is a zone.
struct CellSplits {
  std::vector<SideId> sides;  ///< Ascending; none is in a group.
  /// For each of these sides and each of its cells in order (zone_lookup.h): kNotCut, or the number of the
  /// corner that it is cut from, plus 1, and then the same of its first half and of its second.
  std::vector<std::uint8_t> cuts;

  static constexpr std::uint8_t kNotCut = 0;
};

}  // namespace reemit
