#pragma once
#include <cstdint>

#include "mesh/zones/zone_lookup.h"
#include "scenes/model/ids.h"

namespace reemit {

/// A point on one side of a base triangle.
struct SidePoint {
  TriangleId triangle;
  Barycentric at;
  bool front = true;
};

/// One of the divisions^2 congruent parts of a side of a base triangle (zone_lookup.h); divisions are those
/// of the triangle, or a power of 2 times as many (CellSplits).
struct SideCell {
  TriangleId triangle;
  bool front = true;
  std::uint32_t divisions = 1;
  std::uint32_t number = 0;
};

/// The point of a cell that is a and b of its edges away from its first corner: uniform over the cell for
/// a, b uniform over the triangle a, b >= 0, a + b <= 1.
SidePoint cell_point(const SideCell& cell, float a, float b);

}  // namespace reemit
