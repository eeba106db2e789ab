#pragma once
#include "mesh/zones/cell_corners.h"
#include "scenes/model/ids.h"

namespace reemit {

/// A point on one side of a base triangle.
struct SidePoint {
  TriangleId triangle;
  Barycentric at;
  bool front = true;
};

/// A cell of a side of a base triangle; without corners, the whole side.
struct SideCell {
  TriangleId triangle;
  bool front = true;
  CellCorners corners;
};

/// The point of a cell that is a and b of its edges away from its first corner: uniform over the cell for
/// a, b uniform over the triangle a, b >= 0, a + b <= 1.
SidePoint cell_point(const SideCell& cell, float a, float b);

}  // namespace reemit
