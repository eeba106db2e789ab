#pragma once
#include "scenes/model/photometry.h"

namespace reemit {

// Directions in proportion to the intensity of a measured luminaire: the exact distribution of the bilinear
// interpolant, without rejection or tabulated steps. The marginal of the polar angle is piecewise linear
// times a sine, inverted by Newton's method on its closed form; given that angle, the azimuth has a piecewise
// linear density, inverted by the quadratic formula. All are pure functions and may be called from any
// thread.

/// Unit direction in luminaire coordinates for two uniform numbers in [0,1); continuous in both within the
/// grid. Its density per steradian is intensity over total flux.
Vec3 sample_intensity(const IntensityTable& table, double u0, double u1);

}  // namespace reemit
