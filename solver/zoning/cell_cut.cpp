#include "solver/zoning/cell_cut.h"

#include <algorithm>
#include <array>

#include "mesh/zones/zone_cells.h"
#include "mesh/zones/zone_cost.h"
#include "solver/zoning/light_level.h"

namespace reemit {
namespace {

/// Light that is not linear between corners counts as a variance times this.
constexpr double kBentWeight = 2;
/// Share of the variance of the light on a cell from which on that is looked into.
constexpr double kBent = 0.5;

/// Variance of place in a cell [m2]: of a uniform point in a triangle the sum of the squares of its edges
/// over 36. Of a curved patch, that of the triangle between its corners.
double place_variance(const ZoneMesh& mesh, const SideCell& cell) {
  const std::array<Vec3, 3> corners = corner_points(mesh, cell);
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k) squares += (corners[(k + 1) % 3] - corners[k]).squaredNorm();
  return squares / 36;
}

/// Of the variance of place, what a cut from this corner takes away.
double place_saved(const ZoneMesh& mesh, const SideCell& cell, double place, std::size_t corner) {
  const CellHalves halves = halves_of(cell.corners, corner);
  SideCell half = cell;
  for (const CellCorners& corners : {halves.first, halves.second}) {
    half.corners = corners;
    place -= place_variance(mesh, half) / 2;
  }
  return place;
}

/// How uneven the light on a cell is for zones and vertices.
class LightOnCell {
 public:
  LightOnCell(const SideCell& cell, bool with_rim, PilotLight::Looker& looker, CellLooks& looks)
      : looks_(looks) {
    look_at_points(cell, looker, looks);
    const LightSpread light = spread_of(looks.points);
    mean_ = light.mean();
    variance_ = all_ = light.variance();
    if (!with_rim) return;
    look_at_corners(cell, looker, looks);
    const double bent = kBentWeight * bent_variance(looks);
    is_bent_ = bent > kBent * variance_;
    if (is_bent_) look_at_middles(cell, looker, looks);
    all_ = std::max(variance_, bent);
  }

  double mean() const { return mean_; }
  double variance() const { return all_; }
  /// Of that, what a cut from this corner takes away.
  double saved(std::size_t corner) const {
    const double between = variance_between_halves(looks_, corner);
    if (!is_bent_) return between;
    const double left = kBentWeight * bent_variance_of_halves(looks_, corner);
    return std::max(0.0, all_ - std::max(variance_ - between, left));
  }

 private:
  const CellLooks& looks_;
  double mean_ = 0;
  double variance_ = 0;  // for zones alone
  double all_ = 0;
  bool is_bent_ = false;
};

}  // namespace

CellCut best_cut(const SideCell& cell, const CellScale& scale, const PilotLight& pilot,
                 PilotLight::Looker& looker, CellLooks& looks) {
  const ZoneMesh& mesh = pilot.mesh();
  const double area = cell_area(mesh, cell);
  const double place = place_variance(mesh, cell);
  const LightOnCell light(cell, area >= scale.rim_area, looker, looks);
  const auto cost_of_light = [&](double variance) {
    return kUnevenWeight * scale.zone_area * unevenness(light.mean(), variance, pilot.mean());
  };
  CellCut best;
  best.cost = area * (place + cost_of_light(light.variance()));
  for (std::size_t k = 0; k < 3; ++k) {
    if (!can_halve(cell.corners, k)) continue;
    const double saved = area * (place_saved(mesh, cell, place, k) + cost_of_light(light.saved(k)));
    if (saved > best.saved) {
      best.saved = saved;
      best.corner = k;
    }
  }
  return best;
}

}  // namespace reemit
