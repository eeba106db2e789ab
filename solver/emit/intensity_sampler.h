#pragma once
#include "scenes/model/photometry.h"

namespace reemit {

// Directions in proportion to the intensity of a measured luminaire: the exact distribution of the bilinear
// interpolant, without rejection or tabulated steps. The marginal of the polar angle is piecewise linear
// times a sine, inverted by Newton's method on its closed form; given that angle, the azimuth has a piecewise
// linear density, inverted by the quadratic formula. All are pure functions and may be called from any
// thread.

/// 16 points of the unit square [0,1)^2.
struct alignas(64) SquarePoints16 {
  double u0[16], u1[16];
};
/// 16 unit vectors.
struct alignas(64) Directions16 {
  double x[16], y[16], z[16];
  Vec3 direction(int lane) const { return {x[lane], y[lane], z[lane]}; }
};

/// Unit directions in luminaire coordinates; continuous in both numbers of a point within the grid. Their
/// density per steradian is intensity over total flux.
void sample_intensity16(const IntensityTable& table, const SquarePoints16& at, Directions16& to);

/// One of them.
Vec3 sample_intensity(const IntensityTable& table, double u0, double u1);

}  // namespace reemit
