#pragma once
#include <vector>

#include "mesh/zones/cell_splits.h"
#include "scenes/model/work_watch.h"
#include "solver/zoning/pilot_light.h"

namespace reemit {

/// How far cells are cut.
struct CellBudget {
  double cells = 0;  ///< About as many in all, [1, 1e9].
  double zone_area =
      0;  ///< Of a zone that costs what is fine in even light [m2]: none that costs less is cut.
};

/// Cuts the cells of these sides of `base`, divided as its triangles say, where light differs: that
/// first whose cut saves most (cell_cut.h), until there are as many as wanted. The same for any number of
/// threads. Pre: `base` has the triangles of the pilot's mesh. Throws Interrupted when `watch` ends it.
CellSplits refine_cells(const PilotLight& pilot, const BaseMesh& base, const std::vector<SideId>& sides,
                        const CellBudget& budget, const WorkWatch& watch);

}  // namespace reemit
