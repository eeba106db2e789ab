#include "viewer_export/output/smoothing_errors.h"

#include <algorithm>
#include <cmath>

namespace reemit {

SmoothingErrors::SmoothingErrors(SmoothedValues& smoothed, std::size_t bands, std::size_t band,
                                 const std::vector<double>& scale)
    : smoothed_(smoothed), bands_(bands), band_(band), scale_(scale) {
  double explained = 0;
  double found = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const std::size_t k = i * bands + band;
    explained += static_cast<double>(smoothed.variance[k]) * scale[i] * scale[i];
    found += std::pow(static_cast<double>(smoothed.halves_apart[k]) * scale[i], 2);
  }
  if (explained > 0) shared_ = std::max(1.0, found / explained);
}

void SmoothingErrors::complete(std::span<const std::size_t> group, const std::vector<float>& before,
                               const std::vector<float>& stderrs) {
  double sum = 0;
  double count = 0;
  for (const std::size_t i : group) {
    if (!(scale_[i] > 0)) continue;
    const std::size_t k = i * bands_ + band_;
    const double off = static_cast<double>(smoothed_.value[k]) - static_cast<double>(before[k]);
    const double expected = std::pow(static_cast<double>(stderrs[k]), 2) -
                            2 * static_cast<double>(smoothed_.covariance[k]) +
                            static_cast<double>(smoothed_.variance[k]);
    sum += scale_[i] * scale_[i] * (off * off - expected);
    ++count;
  }
  const double misplaced = count > 0 ? std::max(0.0, sum / count) : 0;
  for (const std::size_t i : group) {
    float& variance = smoothed_.variance[i * bands_ + band_];
    variance = static_cast<float>(shared_ * static_cast<double>(variance) +
                                  (scale_[i] > 0 ? misplaced / (scale_[i] * scale_[i]) : 0));
  }
}

}  // namespace reemit
