#pragma once
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

struct ZoneShare {
  ZoneId zone;
  double share;  ///< Of the area of another zone (0,1].
};

/// The zones behind a zone, on the other side of its triangles, whose light comes through where these are
/// translucent. The shares add up to 1; none where the other side has no zones. A zone behind that is smaller
/// than a sixteenth of a triangle's cell may be missed.
std::vector<ZoneShare> opposite_zones(const ZoneMesh& mesh, ZoneId zone);

}  // namespace reemit
