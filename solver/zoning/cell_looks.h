#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "solver/zoning/pilot_light.h"

namespace reemit {

/// What was seen on a cell. Much of it tells about its halves as well.
struct CellLooks {
  std::vector<SeenPoint> points;
  /// Where exports have their vertices: just inside the corners.
  std::array<std::optional<Seen>, 3> corner;
  /// Likewise in the middle of the edge opposite each of them: halves get a corner there.
  std::array<std::optional<Seen>, 3> middle;
};

/// What is known of the halves (halves_of) of a cell that is cut from this corner.
std::pair<CellLooks, CellLooks> looks_of_halves(const CellLooks& looks, std::size_t corner);

/// Looks at the corners that were not looked at. What is seen can be compared with what points show.
void look_at_corners(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks);
/// Likewise at the middles of edges.
void look_at_middles(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks);
/// Likewise at new points, until there are enough.
void look_at_points(const SideCell& cell, PilotLight::Looker& looker, CellLooks& looks);

/// Mean square of what points differ by from what an export shows there, which is what the corners have,
/// linearly in between: 0 on average where light is linear. As in LightSpread, the noise of one look is
/// independent of that of the other. Pre: all corners were looked at.
double bent_variance(const CellLooks& looks);
/// The same if the cell is cut from this corner. Pre: the middle opposite it was looked at as well.
double bent_variance_of_halves(const CellLooks& looks, std::size_t corner);

/// Of the variance of light over a cell, what lies between the halves when it is cut from this corner;
/// noise as above.
double variance_between_halves(const CellLooks& looks, std::size_t corner);

}  // namespace reemit
