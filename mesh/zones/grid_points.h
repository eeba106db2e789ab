#pragma once
#include <cstdint>

#include "mesh/zones/cell_corners.h"

namespace reemit {

/// Pre: 0 <= i, j <= 65535.
inline GridPoint grid_point(std::int64_t i, std::int64_t j) {
  return {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)};
}

/// The same place on a grid `times` as fine.
inline GridPoint on_finer_grid(const GridPoint& p, std::uint32_t times) {
  return grid_point(std::int64_t{times} * p.i, std::int64_t{times} * p.j);
}

/// Whether the middle between two points lies on their grid.
inline bool has_middle(const GridPoint& a, const GridPoint& b) {
  return (a.i + b.i) % 2 == 0 && (a.j + b.j) % 2 == 0;
}

/// Pre: has_middle.
inline GridPoint middle_of(const GridPoint& a, const GridPoint& b) {
  return grid_point((a.i + b.i) / 2, (a.j + b.j) / 2);
}

}  // namespace reemit
