#include "viewer_export/vertex/kept_cells.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "mesh/geometry/disjoint_sets.h"

namespace reemit {
namespace {

/// Irradiance of backs over the mean of the room from which on they count as lit. A single packet of millions
/// that found its way through a crack is no light.
constexpr double kLitShare = 1e-6;

struct EdgeUse {
  std::uint32_t surface, back, low, high;  // ends of the edge by vertex
  std::uint32_t triangle;
  bool forward;  // from low to high
  auto edge() const { return std::tie(surface, back, low, high); }
};

/// The first triangle of the sheet of each triangle: triangles of one surface, with one behind them, that lie
/// on one side of it. Where three or more meet at an edge, sheets end.
std::vector<std::size_t> sheets(const BaseMesh& base) {
  DisjointSets sets(base.triangles.size());
  std::vector<EdgeUse> uses;
  for (std::size_t t = 0; t < base.triangles.size(); ++t) {
    const BaseTriangle& triangle = base.triangles[t];
    if (triangle.is_curved() && t > 0 && base.triangles[t - 1].shape == triangle.shape) sets.join(t - 1, t);
    const auto back =
        static_cast<std::uint32_t>((base.backs.empty() ? SurfaceId() : base.backs[t].surface).index());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle.vertex[k];
      const std::uint32_t b = triangle.vertex[(k + 1) % 3];
      uses.push_back({static_cast<std::uint32_t>(triangle.surface.index()), back, std::min(a, b),
                      std::max(a, b), static_cast<std::uint32_t>(t), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    return std::tuple_cat(x.edge(), std::tie(x.triangle)) < std::tuple_cat(y.edge(), std::tie(y.triangle));
  });
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i + 1;
    while (end < uses.size() && uses[end].edge() == uses[i].edge()) ++end;
    if (end - i == 2 && uses[i].forward != uses[i + 1].forward)
      sets.join(uses[i].triangle, uses[i + 1].triangle);
    i = end;
  }
  std::vector<std::size_t> sheet(base.triangles.size());
  for (std::size_t t = 0; t < sheet.size(); ++t) sheet[t] = sets.find(t);
  return sheet;
}

/// By sheet, whether its backs get light.
std::vector<bool> lit_backs(const Solution& solution, const ZoneCells& cells,
                            const std::vector<std::size_t>& sheet) {
  const ZoneSums& sums = solution.sums;
  const std::size_t channels = sums.channels.count();
  std::vector<double> power(sheet.size());
  std::vector<double> area(sheet.size());
  double total_power = 0;
  double total_area = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double cell_area = cells.area(i);
    const std::size_t z = cells.zone(i).index();
    double irradiance = 0;
    for (std::size_t k = z * channels; k < (z + 1) * channels; ++k) irradiance += sums.total(k);
    total_power += cell_area * irradiance;
    total_area += cell_area;
    const SideCell cell = cells.cell(i);
    if (cell.front) continue;
    const std::size_t s = sheet[cell.triangle.index()];
    power[s] += cell_area * irradiance;
    area[s] += cell_area;
  }
  std::vector<bool> lit(sheet.size());
  for (std::size_t s = 0; s < lit.size(); ++s)
    lit[s] = power[s] * total_area > kLitShare * total_power * area[s];
  return lit;
}

std::vector<bool> lit_cells(const SurfaceModel& surfaces, const Solution& solution, const ZoneCells& cells) {
  const std::vector<std::size_t> sheet = sheets(solution.mesh.base());
  const std::vector<bool> lit = lit_backs(solution, cells, sheet);
  std::vector<bool> kept(cells.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const SideCell cell = cells.cell(i);
    kept[i] = cell.front || lit[sheet[cell.triangle.index()]] || surfaces.emits(cell.triangle, false);
  }
  return kept;
}

}  // namespace

std::vector<bool> kept_cells(const SurfaceModel& surfaces, const Solution& solution, const ZoneCells& cells,
                             bool all_zones, const std::vector<SurfaceId>& only) {
  std::vector<bool> kept =
      all_zones ? std::vector<bool>(cells.size(), true) : lit_cells(surfaces, solution, cells);
  if (only.empty()) return kept;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const SurfaceId surface = solution.mesh.zone_surface(cells.zone(i));
    kept[i] = kept[i] && std::find(only.begin(), only.end(), surface) != only.end();
  }
  return kept;
}

}  // namespace reemit
