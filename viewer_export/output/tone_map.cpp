#include "viewer_export/output/tone_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace reemit {
namespace {

// White lies at least this many times above the log-average, else a picture of one tone would be pulled to
// white.
constexpr double kSmallestWhiteRatio = 4.0;
// Share of the lit pixels below white: a lamp in view should not decide over the contrast of the whole room.
constexpr double kWhiteQuantile = 0.995;

// Luminances of the pixels that can be shown, in the order of the picture.
std::vector<double> lit_luminances(std::span<const float> rgb) {
  std::vector<double> lit;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const double y = luminance({rgb[i], rgb[i + 1], rgb[i + 2]});
    if (std::isfinite(y) && y > 0) lit.push_back(y);
  }
  return lit;
}

}  // namespace

ToneMap::ToneMap(double exposure, double white) : exposure_(exposure), white_(white) {
  if (!(std::isfinite(exposure) && exposure > 0))
    throw std::invalid_argument("exposure must be finite and > 0");
  if (!(std::isfinite(white) && white > 0)) throw std::invalid_argument("white must be finite and > 0");
}

double ToneMap::exposure_ev() const {
  return std::log2(exposure_);
}

double ToneMap::display_luminance(double exposed) const {
  if (!(exposed > 0)) return 0;
  if (exposed >= white_) return 1;
  return std::min(1.0, exposed * (1 + exposed / (white_ * white_)) / (1 + exposed));  // [RSSF02] eq. 4
}

Eigen::Array3d ToneMap::operator()(const Eigen::Array3d& rgb) const {
  if (rgb.isNaN().any()) return Eigen::Array3d::Zero();
  if ((rgb == std::numeric_limits<double>::infinity()).any()) return Eigen::Array3d::Ones();
  const double y = luminance(rgb);
  if (!(y > 0)) return Eigen::Array3d::Zero();
  return clamp_to_gamut(rgb * (display_luminance(exposure_ * y) / y), 1.0);
}

std::string ToneMap::statement() const {
  return fmt::format("exposure {:.6g} per W/(m2 sr) ({:+.2f} EV), white at {:.4g}, Reinhard et al. 2002",
                     exposure_, exposure_ev(), white_);
}

ToneMap make_tone_map(std::span<const float> rgb, const ToneMapSettings& settings) {
  if (!(settings.key > 0 && settings.key <= 0.5)) throw std::invalid_argument("key must lie in (0, 0.5]");
  if (settings.white && !(std::isfinite(*settings.white) && *settings.white > 0))
    throw std::invalid_argument("white must be finite and > 0");
  if (settings.exposure_ev) {
    if (!std::isfinite(*settings.exposure_ev)) throw std::invalid_argument("exposure must be finite");
    return {std::exp2(*settings.exposure_ev), settings.white.value_or(ToneMapSettings::kFixedWhite)};
  }
  std::vector<double> lit = lit_luminances(rgb);
  if (lit.empty()) return {1.0, settings.white.value_or(ToneMapSettings::kFixedWhite)};
  double log_sum = 0;
  for (const double y : lit) log_sum += std::log(y);
  const double average =
      std::exp(log_sum / static_cast<double>(lit.size()));  // [RSSF02] eq. 1, lit pixels only

  // The exposed average a is what eq. 4 maps to the key. A given white w is an exposed luminance:
  // a^2/w^2 + (1 - key) a - key = 0. Else white is the multiple r of the average, w = r a: a + 1/r^2 = key (1
  // + a).
  const double key = settings.key;
  double exposed_average = 0;
  double white = 0;
  if (settings.white) {
    white = *settings.white;
    const double b = 1 - key;
    exposed_average = 2 * key / (b + std::sqrt(b * b + 4 * key / (white * white)));
  } else {
    const auto quantile = static_cast<std::ptrdiff_t>(kWhiteQuantile * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), lit.begin() + quantile, lit.end());
    const double least = std::max(kSmallestWhiteRatio, std::sqrt(2 / key));
    const double ratio = std::max(lit[static_cast<std::size_t>(quantile)] / average, least);
    exposed_average = (key - 1 / (ratio * ratio)) / (1 - key);
    white = ratio * exposed_average;
  }
  return {exposed_average / average, white};
}

double srgb_encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  if (x == 1) return 1;  // which the formula misses by rounding
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

std::uint8_t srgb_byte(double linear, double dither) {
  const double scaled = 255.0 * srgb_encoded(std::isnan(linear) ? 0.0 : linear);
  return static_cast<std::uint8_t>(std::min(255.0, std::floor(scaled + dither)));
}

}  // namespace reemit
