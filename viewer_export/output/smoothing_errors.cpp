#include "viewer_export/output/smoothing_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace reemit {
namespace {

/// Items are told apart by how much averaging is to have lessened their variance, in powers of two.
constexpr std::size_t kClasses = 11;
/// Independent means from which what a class says of itself is believed.
constexpr double kEnough = 32;

/// Of a class, or of all: squares of half the difference of halves, and what independent noise would explain.
struct HalvesApart {
  double found = 0;
  double explained = 0;
  double means = 0;  // items, less those that averages have in common

  double ratio() const { return explained > 0 ? found / explained : 1; }
};

}  // namespace

SmoothingErrors::SmoothingErrors(SmoothedValues& smoothed, const std::vector<float>& before,
                                 const std::vector<float>& stderrs, std::size_t bands, std::size_t band,
                                 const std::vector<double>& scale)
    : smoothed_(smoothed), before_(before), stderrs_(stderrs), bands_(bands), band_(band), scale_(scale) {
  std::array<HalvesApart, kClasses> of_class;
  HalvesApart of_all;
  std::vector<std::uint8_t> class_of(scale.size());
  const auto lessened_to = [&](std::size_t k) {
    const double variance = std::pow(static_cast<double>(stderrs[k]), 2);
    return variance > 0 ? static_cast<double>(smoothed.variance[k]) / variance : 1;
  };
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const std::size_t k = i * bands + band;
    const double left = lessened_to(k);
    const double halvings = std::round(-std::log2(std::max(left, 1e-9)));
    class_of[i] = static_cast<std::uint8_t>(std::clamp(halvings, 0.0, static_cast<double>(kClasses - 1)));
    const double explained = static_cast<double>(smoothed.variance[k]) * scale[i] * scale[i];
    if (!(explained > 0)) continue;
    for (HalvesApart* apart : {&of_all, &of_class[class_of[i]]}) {
      apart->found += std::pow(static_cast<double>(smoothed.halves_apart[k]) * scale[i], 2);
      apart->explained += explained;
      apart->means += left;
    }
  }
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const std::size_t k = i * bands + band;
    const HalvesApart& own = of_class[class_of[i]];
    const auto ratio = static_cast<float>((own.means >= kEnough ? own : of_all).ratio());
    smoothed.variance[k] *= ratio;
    smoothed.covariance[k] *= ratio;
  }
}

void SmoothingErrors::complete(std::span<const std::size_t> group) {
  double sum = 0;
  double count = 0;
  for (const std::size_t i : group) {
    if (!(scale_[i] > 0)) continue;
    const std::size_t k = i * bands_ + band_;
    const double off = static_cast<double>(smoothed_.value[k]) - static_cast<double>(before_[k]);
    const double expected = std::pow(static_cast<double>(stderrs_[k]), 2) -
                            2 * static_cast<double>(smoothed_.covariance[k]) +
                            static_cast<double>(smoothed_.variance[k]);
    sum += scale_[i] * scale_[i] * (off * off - expected);
    ++count;
  }
  const double misplaced = count > 0 ? std::max(0.0, sum / count) : 0;
  for (const std::size_t i : group)
    if (scale_[i] > 0)
      smoothed_.variance[i * bands_ + band_] += static_cast<float>(misplaced / (scale_[i] * scale_[i]));
}

}  // namespace reemit
