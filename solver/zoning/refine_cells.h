#pragma once
#include <vector>

#include "mesh/zones/cell_splits.h"
#include "scenes/model/work_watch.h"
#include "solver/zoning/cell_cut.h"

namespace reemit {

/// How far cells are cut.
struct CellBudget {
  double cells = 0;  ///< About as many in all, [1, 1e9].
  /// None is cut that costs less than a zone of zone_area in even light.
  CellScale scale{};
};

/// Cuts the cells of these sides of `base`, divided as its triangles say, where light differs: that
/// first whose cut saves most (cell_cut.h), until there are as many as wanted. The same for any number of
/// threads. Pre: `base` has the triangles of the pilot's mesh. Throws Interrupted when `watch` ends it.
CellSplits refine_cells(const PilotLight& pilot, const BaseMesh& base, const std::vector<SideId>& sides,
                        const CellBudget& budget, const WorkWatch& watch);

}  // namespace reemit
