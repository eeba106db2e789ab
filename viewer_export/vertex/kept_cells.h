#pragma once
#include <vector>

#include "mesh/zones/zone_cells.h"
#include "solver/reflect/surface_model.h"
#include "solver/solution/solution.h"

namespace reemit {

/// By cell, whether it is exported: all fronts, and the backs that light comes to or that emit, or all backs
/// with `all_zones`. Backs of one surface that continue each other across edges stay or go together: a lit
/// back shows no holes where packets happened to miss a zone, and the inside of a closed solid goes although
/// its surface holds lit sheets as well. Of these, those of the surfaces `only`, if there are any in it.
std::vector<bool> kept_cells(const SurfaceModel& surfaces, const Solution& solution, const ZoneCells& cells,
                             bool all_zones, const std::vector<SurfaceId>& only);

}  // namespace reemit
