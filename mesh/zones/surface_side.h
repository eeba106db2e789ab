#pragma once
#include <cstddef>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// Index into arrays that hold something of the front and the back of every surface, in this order.
inline std::size_t surface_side(const ZoneMesh& mesh, SideId side) {
  return 2 * mesh.surface(side).index() + (mesh.shows_front(side) ? 0 : 1);
}

}  // namespace reemit
