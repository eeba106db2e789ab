#include "scenes/model/colour_spectra.h"

#include <algorithm>

#include "scenes/model/colour.h"

namespace reemit {

ColourSpectra::ColourSpectra(const Upsampling& upsampling, std::size_t bands) : bands_(bands) {
  if (bands == 1) return;  // the luminance, as Upsampling::emission has it
  for (std::size_t r = 0; r <= kSteps; ++r)
    for (std::size_t g = 0; g <= kSteps; ++g)
      for (std::size_t b = 0; b <= kSteps; ++b) {
        const Eigen::Array3d rgb =
            Eigen::Array3d(static_cast<double>(r), static_cast<double>(g), static_cast<double>(b)) / kSteps;
        const Upsampled spectrum = upsampling.reflectance(rgb);
        for (const double value : spectrum.values) spectra_.push_back(static_cast<float>(value));
        misses_.push_back(static_cast<float>(spectrum.deviation * rgb.maxCoeff()));
      }
}

ColourSpectra::Mixture ColourSpectra::mixture(const std::array<float, 3>& rgb) {
  constexpr std::array<std::size_t, 3> kStride{(kSteps + 1) * (kSteps + 1), kSteps + 1, 1};
  constexpr auto kCells = static_cast<float>(kSteps);
  std::array<float, 3> within;
  std::size_t corner = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float at = rgb[c] > 0 ? std::min(rgb[c], 1.0F) * kCells : 0.0F;
    const std::size_t cell = std::min(static_cast<std::size_t>(at), kSteps - 1);
    within[c] = at - static_cast<float>(cell);
    corner += cell * kStride[c];
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return within[i] > within[j]; });
  Mixture mixture;
  float left = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    mixture.corner[i] = corner;
    mixture.share[i] = left - within[order[i]];
    left = within[order[i]];
    corner += kStride[order[i]];
  }
  mixture.corner[3] = corner;
  mixture.share[3] = left;
  return mixture;
}

void ColourSpectra::values(const std::array<float, 3>& rgb, std::span<float> values) const {
  if (spectra_.empty()) {
    const Eigen::Array3d weights = rec709_luminance_weights();
    double luminance = 0;
    for (std::size_t c = 0; c < 3; ++c)
      luminance += weights[static_cast<Eigen::Index>(c)] * std::clamp(static_cast<double>(rgb[c]), 0.0, 1.0);
    std::fill(values.begin(), values.end(), static_cast<float>(luminance));
    return;
  }
  const Mixture mix = mixture(rgb);
  std::array<const float*, 4> spectrum;
  for (std::size_t i = 0; i < 4; ++i) spectrum[i] = &spectra_[mix.corner[i] * bands_];
  for (std::size_t b = 0; b < bands_; ++b)
    values[b] = (mix.share[0] * spectrum[0][b] + mix.share[1] * spectrum[1][b]) +
                (mix.share[2] * spectrum[2][b] + mix.share[3] * spectrum[3][b]);
}

double ColourSpectra::deviation(const std::array<float, 3>& rgb) const {
  const float largest = std::max({rgb[0], rgb[1], rgb[2]});
  if (spectra_.empty() || !(largest > 0)) return 0;
  const Mixture mix = mixture(rgb);
  double miss = 0;
  for (std::size_t i = 0; i < 4; ++i) miss += static_cast<double>(mix.share[i] * misses_[mix.corner[i]]);
  return miss / static_cast<double>(largest);
}

}  // namespace reemit
