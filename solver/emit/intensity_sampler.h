#pragma once
#include <array>

#include "scenes/model/photometry.h"

namespace reemit {

// Directions in proportion to the intensity of a measured luminaire: the exact distribution of the bilinear
// interpolant, without rejection or tabulated steps. The marginal of the polar angle is piecewise linear
// times a sine, inverted by Newton's method on its closed form; given that angle, the azimuth has a piecewise
// linear density, inverted by the quadratic formula. All are pure functions and may be called from any
// thread.

/// Unit direction in luminaire coordinates for two uniform numbers in [0,1); continuous in both within the
/// grid.
Vec3 sample_intensity(const IntensityTable& table, double u0, double u1);

/// Density of sample_intensity per steradian: intensity over total flux.
double intensity_pdf_per_sr(const IntensityTable& table, const Vec3& direction);

/// The uniform numbers of a direction that has intensity.
std::array<double, 2> invert_intensity(const IntensityTable& table, const Vec3& direction);

}  // namespace reemit
