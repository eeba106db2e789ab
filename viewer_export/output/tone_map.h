#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "scenes/model/colour.h"

namespace reemit {

/// How radiance becomes what a display shows.
struct ToneMapSettings {
  /// Exposure in stops: radiance [W/(m2 sr)] is multiplied by 2^exposure_ev. Unset: from the picture itself,
  /// so that its log-average luminance is shown as `key`.
  std::optional<double> exposure_ev;
  /// Luminance after exposure that is shown as full white, > 0. Unset: from the picture with automatic
  /// exposure, kFixedWhite with a fixed one, so that pictures of one exposure compare.
  std::optional<double> white;
  double key = 0.18;  ///< Display-linear value of the log-average luminance (0, 0.5].

  static constexpr double kFixedWhite = 8.0;
};

/// Luminance of linear Rec.709; 179 lm/W times this is cd/m2.
inline double luminance(const Eigen::Array3d& rgb) {
  return (rec709_luminance_weights() * rgb).sum();
}

/// The global operator of Reinhard et al. 2002 [RSSF02], eq. 4, applied to luminance; the colour keeps its
/// hue. A colour too saturated to be shown at its luminance moves towards grey until it can be.
class ToneMap {
 public:
  /// Throws std::invalid_argument unless both are finite and > 0.
  ToneMap(double exposure, double white);

  double exposure() const { return exposure_; }  ///< Factor on radiance.
  double exposure_ev() const;                    ///< log2 of the factor.
  double white() const { return white_; }        ///< Luminance after exposure that is shown as 1.

  /// Display-linear luminance of a luminance after exposure: monotone, 0 -> 0, white -> 1, never above 1.
  double display_luminance(double exposed) const;
  /// Linear Rec.709 in [0,1] of a radiance in linear Rec.709. Not finite or negative parts count as 0, +inf
  /// as white.
  Eigen::Array3d operator()(const Eigen::Array3d& rgb) const;

  std::string statement() const;  ///< One line for headers: exposure, stops and white.

 private:
  double exposure_;
  double white_;
};

/// The tone map for a picture given as radiances in linear Rec.709, 3 values per pixel. Only finite pixels
/// above 0 count; without any the exposure is 1. Throws std::invalid_argument for settings out of range.
ToneMap make_tone_map(std::span<const float> rgb, const ToneMapSettings& settings = {});

/// sRGB transfer function [IEC61966], linear [0,1] -> encoded [0,1].
double srgb_encoded(double linear);

/// Encoded 8-bit value of a display-linear one. `dither` in [0,1) spreads the rounding error: 0.5 rounds to
/// nearest; exact 0 and exact 1 stay 0 and 255.
std::uint8_t srgb_byte(double linear, double dither = 0.5);

}  // namespace reemit
