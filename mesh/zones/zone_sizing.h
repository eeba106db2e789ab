#pragma once
#include <vector>

#include "mesh/model/mesh_settings.h"
#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// The zone area that settings ask for [m2], for a room with the given area of all sides that have zones
/// [m2]. Throws InputError when a setting is out of its range.
double wanted_zone_area(const MeshSettings& settings, double zoned_area);
/// How many zones that is in the mean.
double wanted_zone_count(const MeshSettings& settings, double zoned_area);

/// The smallest of 1, 2, 3, 4, 6, 8, 12, 16, 24, ... (2^k and 3*2^k) that is at least `n`: of two of them,
/// the smaller mostly divides the larger, so that zones of neighbouring triangles share vertices.
std::uint32_t divisions_at_least(double n);

/// How fine a side of `area` [m2] is divided for zones of `zone_area`.
double wanted_divisions(double area, double zone_area);

/// Sets the divisions of every triangle so that no cell exceeds `zone_area` [m2]; `dark`, if given, by
/// triangle, leaves those as they are that no light reaches. Throws InputError when that makes more than 2^31
/// cells.
void size_zones(BaseMesh& mesh, double zone_area, const std::vector<bool>& dark = {});

}  // namespace reemit
