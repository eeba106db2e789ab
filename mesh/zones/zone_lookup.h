#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace reemit {

// A base triangle with `divisions` n is cut into n*n congruent zones by lines parallel to its sides, in the
// barycentric coordinates of Embree: p = (1-u-v) p0 + u p1 + v p2. Zones are numbered in rows of constant
// floor(u n). Row i holds 2(n-i)-1 triangles, lower ones (with the orientation of the whole triangle) and
// upper ones in turn, so row i starts at number 2ni - i*i.

/// Place of a zone in the grid of its base triangle: cell (i,j) spans u n in [i,i+1], v n in [j,j+1].
struct ZoneCell {
  std::int64_t i, j;
  bool upper;  ///< The half of the cell away from its corner (i,j).
};

/// Place of the zone of a base triangle that holds barycentric point (u,v); any u, v are clamped into it.
inline ZoneCell place_in_triangle(std::uint32_t divisions, float u, float v) {
  const auto n = static_cast<std::int64_t>(divisions);
  const float un = u * static_cast<float>(n);
  const float vn = v * static_cast<float>(n);
  const std::int64_t i = std::clamp<std::int64_t>(static_cast<std::int64_t>(un), 0, n - 1);
  const std::int64_t j = std::clamp<std::int64_t>(static_cast<std::int64_t>(vn), 0, n - 1 - i);
  return {i, j, (un - static_cast<float>(i)) + (vn - static_cast<float>(j)) > 1.0F && j < n - 1 - i};
}

/// The number of a place: the inverse of zone_cell.
inline std::uint32_t cell_number(std::uint32_t divisions, const ZoneCell& cell) {
  const auto n = static_cast<std::int64_t>(divisions);
  return static_cast<std::uint32_t>(2 * n * cell.i - cell.i * cell.i + 2 * cell.j + (cell.upper ? 1 : 0));
}

/// Number of the zone of place_in_triangle.
inline std::uint32_t zone_in_triangle(std::uint32_t divisions, float u, float v) {
  return divisions == 1 ? 0 : cell_number(divisions, place_in_triangle(divisions, u, v));
}

struct Barycentric {
  double u, v;
};

/// Parts of a cell that is cut between the middles of its edges.
inline constexpr std::uint32_t kCellParts = 4;

/// Place, in the grid twice as fine, of one of them: at corner 0, 1 or 2 of the cell as it lies in its own
/// orientation, an upper one being a lower one turned half round; or 3, in the middle.
inline ZoneCell cell_part(const ZoneCell& cell, std::uint32_t part) {
  const std::int64_t to_u = part == 1 ? 1 : 0;
  const std::int64_t to_v = part == 2 ? 1 : 0;
  const bool is_turned = cell.upper != (part == 3);
  if (cell.upper) return {2 * cell.i + 1 - to_u, 2 * cell.j + 1 - to_v, is_turned};
  return {2 * cell.i + to_u, 2 * cell.j + to_v, is_turned};
}

/// A point in the coordinates of a cell in its own orientation: a, b >= 0, a + b <= 1.
struct InCell {
  float a, b;
};

/// Of barycentric point (u,v), in the cell that place_in_triangle finds for it.
inline InCell in_cell(std::uint32_t divisions, const ZoneCell& cell, float u, float v) {
  const float a = u * static_cast<float>(divisions) - static_cast<float>(cell.i);
  const float b = v * static_cast<float>(divisions) - static_cast<float>(cell.j);
  return cell.upper ? InCell{1 - a, 1 - b} : InCell{a, b};
}

/// The part of a cell that holds a point of it, which is put into the coordinates of that part. Which part it
/// is nothing could predict, so there are no branches.
inline std::uint32_t part_of(InCell& x) {
  const float a = 2 * x.a;
  const float b = 2 * x.b;
  const auto first = static_cast<std::uint32_t>(a >= 1);
  const auto second = static_cast<std::uint32_t>(b >= 1) & (first ^ 1U);
  const auto middle = static_cast<std::uint32_t>(a + b > 1) & ((first | second) ^ 1U);
  const auto turn = static_cast<float>(1 - 2 * static_cast<std::int32_t>(middle));
  const auto to_a = static_cast<float>(static_cast<std::int32_t>(middle) - static_cast<std::int32_t>(first));
  const auto to_b = static_cast<float>(static_cast<std::int32_t>(middle) - static_cast<std::int32_t>(second));
  x = {to_a + turn * a, to_b + turn * b};
  return first + 2 * second + 3 * middle;
}

/// Inverse of the numbering of zone_in_triangle.
inline ZoneCell zone_cell(std::uint32_t divisions, std::uint32_t zone) {
  const auto n = static_cast<std::int64_t>(divisions);
  const auto z = static_cast<std::int64_t>(zone);
  auto i = static_cast<std::int64_t>(static_cast<double>(n) - std::sqrt(static_cast<double>(n * n - z)));
  while (2 * n * (i + 1) - (i + 1) * (i + 1) <= z) ++i;  // the square root may be off by one for large n
  while (2 * n * i - i * i > z) --i;
  const std::int64_t in_row = z - (2 * n * i - i * i);
  return {i, in_row / 2, in_row % 2 != 0};
}

/// Corners of zone `zone` of a base triangle, counter-clockwise as the triangle itself.
inline std::array<Barycentric, 3> zone_corners(std::uint32_t divisions, std::uint32_t zone) {
  const auto [i, j, upper] = zone_cell(divisions, zone);
  const double h = 1.0 / static_cast<double>(divisions);
  const auto at = [h](std::int64_t a, std::int64_t b) {
    return Barycentric{h * static_cast<double>(a), h * static_cast<double>(b)};
  };
  if (upper) return {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
  return {at(i, j), at(i + 1, j), at(i, j + 1)};
}

}  // namespace reemit
