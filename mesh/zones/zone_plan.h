#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_groups.h"
#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// How a room is cut into about as many zones as wanted.
struct ZonePlan {
  double zone_area = 0;  ///< For size_zones [m2].
  ZoneGroups groups;
};

/// What is to become of a side of a base triangle.
enum class SideUse : std::uint8_t {
  kShared,  ///< May share a zone with others, if there are too many.
  kOwn,     ///< Has zones of its own.
  kSealed,  ///< No light reaches it.
};

/// `mesh` as size_zones made it with `zone_area` [m2]; `uses` and `light`, if there is any, by side
/// as in ZoneGroups; light is the logarithm of 1 + B/m, B what the side reflects and m what counts as dim.
/// All sealed sides of one surface become one group, fronts and backs apart, and do not count. If the others
/// have up to half as many zones again as wanted, they stay as they are. Else small sides are put together
/// within their surface: starting with one group for each surface and side, the group in which light is
/// likely to differ most, by area, extent, directions of normals and light, is cut in two, until it is as
/// uneven as a cell of a large face; and cells become larger, up to `largest_zone_area` [m2], until there are
/// about as many of both as wanted. Deterministic.
ZonePlan plan_zones(const ZoneMesh& mesh, const std::vector<SideUse>& uses, const std::vector<float>& light,
                    double wanted, double zone_area, double largest_zone_area);

}  // namespace reemit
