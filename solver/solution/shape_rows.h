#pragma once
#include <array>
#include <cstddef>

#include "scenes/model/shape.h"

namespace reemit {

/// Numbers that a curved shape takes in a solution file: kind (0 sphere, 1 disk, 2 cylinder, 3 cone), centre
/// or base (3), normal or top (3), radius, second radius (hole of a disk, top of a cone), 1 if inward.
inline constexpr std::size_t kShapeRow = 10;

/// Lengths [m]; numbers that a kind does not have are 0.
std::array<double, kShapeRow> row_of(const CurvedShape& shape);

/// The shape of a row. Throws std::invalid_argument when the numbers make no shape with an area.
CurvedShape shape_of(const double* row);

}  // namespace reemit
