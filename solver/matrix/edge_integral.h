#pragma once
#include "scenes/model/vec.h"

namespace reemit {

/// A straight edge in space.
struct Edge {
  Vec3 start;
  Vec3 direction;     ///< Unit.
  double length = 0;  ///< > 0
  Vec3 end() const { return start + length * direction; }
};

/// Integral over two edges of ln r, with r the distance between a point of one and a point of the other, by
/// arc length on both. The edges may touch, cross or coincide; the integral is finite. The integral along one
/// edge is taken in closed form, along the other by Gauss-Legendre rules of an order that follows from how
/// close the nearest singularity of the integrand in the complex plane is; where that is too close the edge
/// is halved, which grades the pieces towards corners that the edges share. Parallel edges near each other
/// have a closed form. Absolute error about 1e-13 times the product of the lengths when distances are of the
/// order of 1.
double integral_of_log_distance(const Edge& p, const Edge& q);

}  // namespace reemit
