#include "solver/zoning/cell_cut.h"

#include <algorithm>
#include <array>

#include "mesh/zones/zone_cells.h"
#include "mesh/zones/zone_cost.h"
#include "solver/zoning/light_level.h"

namespace reemit {
namespace {

/// Points of a cell: those seen before count among them, but some are new, for by the old ones the cut was
/// chosen that left the cell.
constexpr int kPoints = 8;
constexpr int kNewPoints = 2;
constexpr int kShadowRays = 4;
constexpr int kGatherRays = 8;

/// Variance of place in a cell [m2]: of a uniform point in a triangle the sum of the squares of its edges
/// over 36. Of a curved patch, that of the triangle between its corners.
double place_variance(const ZoneMesh& mesh, const SideCell& cell) {
  const std::array<Vec3, 3> corners = corner_points(mesh, cell);
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k) squares += (corners[(k + 1) % 3] - corners[k]).squaredNorm();
  return squares / 36;
}

/// Of the variance of light over a cell, what lies between its halves: as in LightSpread, the noise of one
/// look is independent of that of the other.
double variance_between_halves(const std::vector<SeenPoint>& points, std::uint32_t corner) {
  std::array<std::size_t, 2> count{};
  std::array<double, 2> first{};
  std::array<double, 2> second{};
  for (const SeenPoint& point : points) {
    InCell at = point.at;
    const std::uint32_t half = half_of(at, corner);
    ++count[half];
    first[half] += static_cast<double>(point.first_look);
    second[half] += static_cast<double>(point.second_look);
  }
  if (count[0] == 0 || count[1] == 0) return 0;
  const auto n0 = static_cast<double>(count[0]);
  const auto n1 = static_cast<double>(count[1]);
  const double product = (first[0] / n0 - first[1] / n1) * (second[0] / n0 - second[1] / n1);
  return n0 * n1 / ((n0 + n1) * (n0 + n1)) * product;
}

}  // namespace

CellCut best_cut(const SideCell& cell, double zone_area, const PilotLight& pilot, PilotLight::Looker& looker,
                 std::vector<SeenPoint>& points) {
  const ZoneMesh& mesh = pilot.mesh();
  const double area = cell_area(mesh, cell);
  const double place = place_variance(mesh, cell);
  const int missing = std::max(kNewPoints, kPoints - static_cast<int>(points.size()));
  looker.look(cell, {missing, kShadowRays, kGatherRays});
  points.insert(points.end(), looker.points().begin(), looker.points().end());
  const LightSpread light = spread_of(points);
  const auto cost_of_light = [&](double variance) {
    return kUnevenWeight * zone_area * unevenness(light.mean(), variance, pilot.mean());
  };
  CellCut best;
  best.cost = area * (place + cost_of_light(light.variance()));
  for (std::size_t k = 0; k < 3; ++k) {
    if (!can_halve(cell.corners, k)) continue;
    const CellHalves halves = halves_of(cell.corners, k);
    SideCell half = cell;
    double place_saved = place;
    for (const CellCorners& corners : {halves.first, halves.second}) {
      half.corners = corners;
      place_saved -= place_variance(mesh, half) / 2;
    }
    const double between = variance_between_halves(points, static_cast<std::uint32_t>(k));
    const double saved = area * (place_saved + cost_of_light(between));
    if (saved > best.saved) {
      best.saved = saved;
      best.corner = k;
    }
  }
  return best;
}

std::vector<SeenPoint> take_second_half(std::vector<SeenPoint>& points, std::size_t corner) {
  std::vector<SeenPoint> second;
  std::erase_if(points, [&](SeenPoint& point) {
    if (half_of(point.at, static_cast<std::uint32_t>(corner)) == 0) return false;
    second.push_back(point);
    return true;
  });
  return second;
}

}  // namespace reemit
