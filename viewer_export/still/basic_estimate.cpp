#include "viewer_export/still/basic_estimate.h"

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>

#include "viewer_export/still/pixel_rows.h"

namespace reemit {
namespace {

/// Means of a plane over squares of 2 reach + 1 pixels to a side, as far as they are in the picture.
std::vector<float> means_around(const std::vector<float>& plane, const StillPlanes& planes, int reach) {
  std::vector<float> along(plane.size());
  std::vector<float> means(plane.size());
  const auto width = static_cast<std::size_t>(planes.width);
  tbb::parallel_for(0, planes.height, [&](int y) {
    pixel_rows::average_along(&along[planes.at(0, y)], &plane[planes.at(0, y)], reach, width);
  });
  tbb::parallel_for(0, planes.height, [&](int y) {
    const int top = std::max(0, y - reach);
    const int bottom = std::min(planes.height, y + reach + 1);
    pixel_rows::average_across(&means[planes.at(0, y)], &along[planes.at(0, top)],
                               static_cast<std::size_t>(bottom - top), width, width);
  });
  return means;
}

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
  for (std::size_t b = 0; b < planes.bands; ++b) add_shared_noise(planes, b);
}

void BasicEstimate::add_shared_noise(const StillPlanes& planes, std::size_t band) {
  constexpr int kReach = 16;
  constexpr float kMost = 10;  // of a pixel: edges in strong noise stay
  const std::size_t n = planes.pixels();
  std::vector<float> ratios(n, 1.0F);
  for (std::size_t p = 0; p < n; ++p) {
    const std::size_t at = band * n + p;
    const float apart = value_[0][at] - value_[1][at];
    if (variance_[at] > 0) ratios[p] = std::min(kMost, 0.5F * apart * apart / variance_[at]);
  }
  const std::vector<float> factors = means_around(ratios, planes, kReach);
  for (std::size_t p = 0; p < n; ++p) variance_[band * n + p] *= std::max(1.0F, factors[p]);
}

PixelGuide BasicEstimate::guide() const {
  constexpr int kPatch = 2;
  constexpr float kStrength = 1;
  constexpr float kNoise = 0.5F;
  return {{value_[0].data(), value_[1].data()}, variance_.data(), kPatch, kStrength, kNoise};
}

}  // namespace reemit
