#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace reemit {

/// One part of the irradiance of vertices as two estimates that share no random number, of one half of the
/// replicates each. Index vertex * bands + band.
struct VertexLayer {
  std::array<std::vector<float>, 2> half;  ///< [W/m2]
  std::vector<float> variance;             ///< Square of the standard error of one half [W2/m4].
};

/// Straight from luminaires, from other surfaces, and in rooms that bend light from luminaires over mirrors
/// and glass. Empty: not kept.
using VertexLayers = std::vector<VertexLayer>;

}  // namespace reemit
