#pragma once
#include <vector>

#include "solver/zoning/pilot_light.h"

namespace reemit {

/// What a cell costs (zone_cost.h), and the cut into halves that saves most of it.
struct CellCut {
  double cost = 0;         ///< [m4]
  double saved = 0;        ///< Of that, about.
  std::size_t corner = 0;  ///< To cut from (halves_of).
};

/// Looks at the cell, where zones that cost what is fine in even light have this area [m2]. Of what light
/// costs, a cut saves what the halves of the points that were seen differ by; so borders of shadows get cells
/// that are long and lie along them. `points`: of the cell, those seen before, by looks at cells that it is a
/// part of; others are added.
CellCut best_cut(const SideCell& cell, double zone_area, const PilotLight& pilot, PilotLight::Looker& looker,
                 std::vector<SeenPoint>& points);

/// Moves the points of a cell that lie in the second half of this cut from `points` to what is returned, all
/// as points of their halves.
std::vector<SeenPoint> take_second_half(std::vector<SeenPoint>& points, std::size_t corner);

}  // namespace reemit
