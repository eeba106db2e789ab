#include "mesh/zones/cell_corners.h"

#include "mesh/zones/grid_points.h"

namespace reemit {

double CellCorners::share() const {
  const auto from_first = [this](std::size_t k) {
    return std::array<std::int64_t, 2>{at[k].i - at[0].i, at[k].j - at[0].j};
  };
  const auto [i1, j1] = from_first(1);
  const auto [i2, j2] = from_first(2);
  const double n = divisions;
  return static_cast<double>(i1 * j2 - i2 * j1) / (n * n);
}

CellCorners grid_cell(std::uint32_t divisions, std::uint32_t number) {
  const auto [i, j, upper] = zone_cell(divisions, number);
  if (upper) return {divisions, {grid_point(i + 1, j + 1), grid_point(i, j + 1), grid_point(i + 1, j)}};
  return {divisions, {grid_point(i, j), grid_point(i + 1, j), grid_point(i, j + 1)}};
}

CellHalves halves_of(const CellCorners& cell, std::size_t corner) {
  CellCorners fine = cell;
  const std::size_t next = (corner + 1) % 3;
  const std::size_t last = (corner + 2) % 3;
  if (!has_middle(cell.at[next], cell.at[last])) {
    fine.divisions *= 2;
    for (GridPoint& p : fine.at) p = on_finer_grid(p, 2);
  }
  const GridPoint& from = fine.at[corner];
  const GridPoint& a = fine.at[next];
  const GridPoint& b = fine.at[last];
  const GridPoint middle = middle_of(a, b);
  return {{fine.divisions, {from, a, middle}}, {fine.divisions, {from, middle, b}}};
}

bool can_halve(const CellCorners& cell, std::size_t corner) {
  return has_middle(cell.at[(corner + 1) % 3], cell.at[(corner + 2) % 3]) ||
         cell.divisions <= kMostDivisions / 2;
}

}  // namespace reemit
