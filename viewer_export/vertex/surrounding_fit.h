#pragma once
#include <array>
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

/// Fits to the vertices within a number of edges: a surface of second order where there are enough, else a
/// plane, or where their places determine none, their mean. The surrounding must outlive it.
class SurroundingFits {
 public:
  explicit SurroundingFits(const Surrounding& around);

  /// The fit over `hops` edges, [0, Surrounding::kHops].
  void fit(std::size_t hops, SurroundingFit& fit) const;

 private:
  /// Sums of x^a y^b over places in units of unit_, by a + b up to 4, then by b.
  using Moments = std::array<double, 15>;

  const Surrounding& around_;
  double unit_ = 0;                                           // the largest distance [m]
  std::array<double, Surrounding::kHops + 1> size_{};         // the largest within so many edges [m]
  std::array<Moments, Surrounding::kHops + 1> moments_ = {};  // likewise
};

}  // namespace reemit
