#pragma once
#include <cstdint>
#include <vector>

namespace reemit {

/// Sides of base triangles that are one zone together instead of one or more each: small neighbouring ones of
/// one surface, or all sides of a surface that no light reaches. All sides of a group belong to one surface
/// and are fronts, or are backs.
struct ZoneGroups {
  static constexpr std::uint32_t kOwn = 0xffffffff;
  /// By side (side.h), the number of its group; kOwn: it has zones of its own. Empty:
  /// there are no groups.
  std::vector<std::uint32_t> of_side;
  std::uint32_t count = 0;   ///< Of groups; each has a member.
  std::uint32_t sealed = 0;  ///< The first so many are of sides that no light reaches.
};

}  // namespace reemit
