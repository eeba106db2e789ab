#include "viewer_export/still/basic_estimate.h"

#include <cstddef>

namespace reemit {
namespace {

/// Standard deviation of the light that photons bring, over itself, in one half. Its 80 photons in a radius,
/// half of kPhotonsInRadius, would have sqrt(4/3 / 80) = 0.13; where radii are the largest there are fewer.
constexpr float kPhotonNoise = 0.16F;

}  // namespace

BasicEstimate::BasicEstimate(const StillPlanes& planes, const StopToken& stop) {
  const std::size_t n = planes.pixels();
  for (std::vector<float>& of_half : value_) of_half.resize(planes.bands * n);
  variance_.resize(planes.bands * n);
  for_similar_pixels(planes, PixelGuide::of(planes), SimilarPixels::Extent::kNarrow, kSmoothedRows, stop,
                     [&](const SimilarPixels& means, int first, int last) {
                       const std::size_t start = planes.at(0, first);
                       for (std::size_t p = 0; p < planes.at(0, last) - start; ++p)
                         for (std::size_t b = 0; b < planes.bands; ++b) {
                           const std::size_t at = b * n + start + p;
                           for (std::size_t h = 0; h < 2; ++h) value_[h][at] = means.mean(h, 0, b, p);
                           variance_[at] = 2 * means.variance(b, p);
                         }
                     });
  for (std::size_t at = 0; at < planes.caustic.size(); ++at) {
    const float noise = kPhotonNoise * planes.caustic[at];
    variance_[at] += noise * noise;
  }
}

PixelGuide BasicEstimate::guide() const {
  constexpr int kPatch = 2;
  constexpr float kStrength = 1;
  constexpr float kNoise = 0.5F;
  return {{value_[0].data(), value_[1].data()}, variance_.data(), kPatch, kStrength, kNoise};
}

}  // namespace reemit
