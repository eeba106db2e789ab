#pragma once
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit::bench {

/// How far what an export shows between its vertices is from the light there.
struct ExportDifference {
  double rms = 0;  ///< Relative: sqrt(sum d1 d2 / sum r1 r2) over points, evenly over the exported area.
  /// Share of that area where the difference is more than a quarter of the light and a tenth of the mean.
  double wrong_area = 0;
};

/// Gathers at the vertices as `export` does, with many rays and without smoothing, and at `points` points of
/// its triangles, twice with half of the solution each: d1 and d2 are their differences to what is linear
/// between the vertices, r1 and r2 the reflected radiances found. Luminaires are left out.
ExportDifference export_difference(const Room& room, const Solution& solution, std::size_t points);

}  // namespace reemit::bench
