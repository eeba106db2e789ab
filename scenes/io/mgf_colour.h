#pragma once
#include <compare>
#include <span>
#include <utility>

namespace reemit {

/// Colour of an MGF colour context: CIE 1931 chromaticity. That is enough for every MGF colour, as spectra
/// are only relative, are mixed by luminance, and XYZ is linear. The default is equal-energy grey.
struct MgfColour {
  double x = 1.0 / 3;
  double y = 1.0 / 3;

  auto operator<=>(const MgfColour&) const = default;
};

/// x >= 0, y > 0 and x + y <= 1 up to rounding, and y not so small that no visible light has it.
bool is_valid_chromaticity(double x, double y);

// The functions below return a colour for which is_valid_chromaticity may fail (no light in the visible
// range); then its components may be NaN.

/// Spectrum sampled evenly from from_nm to to_nm [nm], linear in between and 0 outside. Needs from < to, >= 2
/// samples.
MgfColour colour_of_spectrum(double from_nm, double to_nm, std::span<const double> samples);

/// Black body [K].
MgfColour colour_of_black_body(double kelvin);

/// Sum of colours weighted by luminance.
MgfColour mix_colours(std::span<const std::pair<double, MgfColour>> parts);

}  // namespace reemit
