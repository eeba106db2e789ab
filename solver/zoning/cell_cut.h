#pragma once
#include "solver/zoning/cell_looks.h"

namespace reemit {

/// What a cell costs (zone_cost.h), and the cut into halves that saves most of it.
struct CellCut {
  double cost = 0;         ///< [m4]
  double saved = 0;        ///< Of that, about.
  std::size_t corner = 0;  ///< To cut from (halves_of).
};

/// What cells are measured by.
struct CellScale {
  double zone_area;  ///< Of a zone that costs what is fine in even light [m2].
  double rim_area;   ///< Cells of less are not looked at where exports have their vertices [m2].
};

/// Looks at the cell. Of what light costs, a cut saves what the halves of the points that were seen differ
/// by; so borders of shadows get cells that are long and lie along them. Where points differ more from what
/// lies between the corners than from each other, such as beside a thing that keeps light from a corner
/// alone, that counts instead. `looks`: what is known of the cell; what is seen is added.
CellCut best_cut(const SideCell& cell, const CellScale& scale, const PilotLight& pilot,
                 PilotLight::Looker& looker, CellLooks& looks);

}  // namespace reemit
