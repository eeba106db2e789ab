#pragma once
#include <cstddef>
#include <vector>

#include "viewer_export/vertex/vertex_surroundings.h"

namespace reemit {

/// How values around a vertex make up that at the vertex of a smooth function of the place fitted to them by
/// least squares.
struct SurroundingFit {
  std::vector<float> weight;  ///< Of the first vertices of the surrounding, the vertex itself before others.
  /// Of the vertex itself; also the sum of the squares of all weights.
  float own_weight() const { return weight.front(); }
};

/// Fits to the vertices within `hops` edges: a surface of second order where there are enough, else a plane,
/// or where their places determine none, their mean.
void fit_surrounding(const Surrounding& around, std::size_t hops, SurroundingFit& fit);

}  // namespace reemit
