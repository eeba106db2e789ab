#pragma once
#include <algorithm>
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

/// A point of a cell by its corners (CellCorners): (1-a-b) of the first, a of the second, b of the third.
struct InCell {
  float a, b;
};

/// Of barycentric point (u,v), in the cell that place_in_triangle finds for it.
inline InCell in_cell(std::uint32_t divisions, const ZoneCell& cell, float u, float v) {
  const float a = u * static_cast<float>(divisions) - static_cast<float>(cell.i);
  const float b = v * static_cast<float>(divisions) - static_cast<float>(cell.j);
  return cell.upper ? InCell{1 - a, 1 - b} : InCell{a, b};
}

/// Which half of a cell cut from `corner` (halves_of) holds a point of it, 0 or 1; the point is put into the
/// coordinates of that half. Which one it is nothing could predict, so there are no branches.
inline std::uint32_t half_of(InCell& x, std::uint32_t corner) {
  const float first = 1 - x.a - x.b;
  const float next = corner == 0 ? x.a : corner == 1 ? x.b : first;  // weight of the corner after it
  const float last = corner == 0 ? x.b : corner == 1 ? first : x.a;
  const float more = next - last;
  const bool is_second = more < 0;
  x = {is_second ? 2 * next : more, is_second ? -more : 2 * last};
  return is_second ? 1 : 0;
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

}  // namespace reemit
