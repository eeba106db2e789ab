#pragma once
#include <random>

#include "mesh/zones/zone_mesh.h"

namespace reemit::test {

/// Cuts the cells of about every second side that has zones, each again with odds of a third, `depth` times
/// at most.
inline CellSplits random_splits(const BaseMesh& base, int depth, unsigned seed) {
  std::mt19937 random(seed);
  const auto odds = [&](unsigned of) { return random() % of == 0; };
  CellSplits splits;
  const auto add = [&](const auto& self, int left) -> void {
    const bool split = left > 0 && odds(3);
    splits.is_split.push_back(split ? 1 : 0);
    for (std::uint32_t k = 0; split && k < kCellParts; ++k) self(self, left - 1);
  };
  for (std::size_t t = 0; t < base.triangles.size(); ++t)
    for (const bool front : {true, false}) {
      const BaseTriangle& triangle = base.triangles[t];
      if ((!front && !triangle.two_sided) || odds(2)) continue;
      splits.sides.push_back(side_of(TriangleId(t), front));
      for (std::uint32_t c = 0; c < triangle.divisions * triangle.divisions; ++c) add(add, depth);
    }
  return splits;
}

}  // namespace reemit::test
