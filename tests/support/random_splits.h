#pragma once
#include <random>

#include "mesh/zones/zone_mesh.h"

namespace reemit::test {

/// Cuts the cells of about every second side that has zones, each again with odds of two thirds, `depth`
/// times at most.
inline CellSplits random_splits(const BaseMesh& base, int depth, unsigned seed) {
  std::mt19937 random(seed);
  const auto odds = [&](unsigned of) { return random() % of == 0; };
  CellSplits splits;
  const auto add = [&](const auto& self, int left) -> void {
    const bool cut = left > 0 && !odds(3);
    splits.cuts.push_back(cut ? static_cast<std::uint8_t>(1 + random() % 3) : CellSplits::kNotCut);
    for (int k = 0; cut && k < 2; ++k) self(self, left - 1);
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
