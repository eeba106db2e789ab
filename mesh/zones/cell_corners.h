#pragma once
#include <array>
#include <cstdint>

#include "mesh/zones/zone_lookup.h"

namespace reemit {

/// A point of a base triangle: u = i / divisions, v = j / divisions (zone_lookup.h).
struct GridPoint {
  std::uint16_t i, j;
  auto operator<=>(const GridPoint&) const = default;
};

/// Finest grid of cells that are cut further.
inline constexpr std::uint32_t kMostDivisions = 32768;

/// A triangle within a base triangle, with the orientation of that: a cell of its grid, or what is left of
/// one that was halved, again and again. By default the whole triangle.
struct CellCorners {
  std::uint32_t divisions = 1;  ///< Of the grid of the corners, [1, 65535].
  std::array<GridPoint, 3> at{{{0, 0}, {1, 0}, {0, 1}}};
  bool operator==(const CellCorners&) const = default;

  Barycentric corner(std::size_t k) const {
    const double h = 1.0 / divisions;
    return {h * at[k].i, h * at[k].j};
  }
  std::array<Barycentric, 3> corners() const { return {corner(0), corner(1), corner(2)}; }
  /// Area over that of the base triangle (0,1].
  double share() const;
};

/// Cell `number` of the divisions^2 of a base triangle. Pre: divisions <= 65535.
CellCorners grid_cell(std::uint32_t divisions, std::uint32_t number);

/// Both parts of a cell that is cut from a corner to the middle of the edge that lies opposite: that with the
/// corner after it and that with the corner before it, each beginning with the corner that is cut from.
struct CellHalves {
  CellCorners first, second;
};
/// Pre: corner < 3, can_halve.
CellHalves halves_of(const CellCorners& cell, std::size_t corner);
/// Whether the middle of that edge lies on a grid of at most kMostDivisions.
bool can_halve(const CellCorners& cell, std::size_t corner);

}  // namespace reemit
