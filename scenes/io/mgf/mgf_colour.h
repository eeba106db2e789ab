#pragma once
#include <compare>
#include <span>
#include <string>
#include <utility>

namespace reemit {

/// Colour of an MGF colour context: CIE 1931 chromaticity. That is enough for every MGF colour, as spectra
/// are only relative, are mixed by luminance, and XYZ is linear. The default is equal-energy grey.
struct MgfColour {
  double x = 1.0 / 3;
  double y = 1.0 / 3;
  /// Where it was given, for messages, if the owner of the colours keeps that. Not part of the colour.
  const std::string* given_at = nullptr;

  bool operator==(const MgfColour& other) const { return x == other.x && y == other.y; }
  std::partial_ordering operator<=>(const MgfColour& other) const {
    return std::pair(x, y) <=> std::pair(other.x, other.y);
  }
};

/// x >= 0, y > 0 and x + y <= 1 up to rounding to three digits, and y not so small that no visible light has
/// it.
bool is_valid_chromaticity(double x, double y);

// The functions below may return a colour that no light has, for which is_valid_chromaticity fails: the
// components of CIE daylight are such colours, and mixtures of them are daylight again. Where there is no
// chromaticity at all, as of a spectrum without visible light, it is (0, 0).

/// Spectrum sampled evenly from from_nm to to_nm [nm], linear in between and 0 outside. Needs from < to, >= 2
/// samples.
MgfColour colour_of_spectrum(double from_nm, double to_nm, std::span<const double> samples);

/// Black body [K].
MgfColour colour_of_black_body(double kelvin);

/// Sum of colours weighted by luminance. A colour with y = 0 has none, and no mixture with it has a
/// chromaticity.
MgfColour mix_colours(std::span<const std::pair<double, MgfColour>> parts);

}  // namespace reemit
