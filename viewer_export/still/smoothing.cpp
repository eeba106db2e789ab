#include "viewer_export/still/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "scenes/model/error.h"
#include "viewer_export/output/smoothing_errors.h"
#include "viewer_export/still/allocate_planes.h"
#include "viewer_export/still/basic_estimate.h"
#include "viewer_export/still/coarse_smoothing.h"
#include "viewer_export/still/layer_totals.h"
#include "viewer_export/still/similar_pixels.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {
namespace {

constexpr int kBlock = 16;  ///< Pixels to a side of a block.

/// What a picture becomes.
struct SmoothedLayers {
  explicit SmoothedLayers(const StillPlanes& planes) {
    std::vector<std::vector<float>*> by_band{&irradiance[0],      &irradiance[1],     &direct,
                                             &radiance.value,     &radiance.variance, &radiance.halves_apart,
                                             &radiance.covariance};
    if (!planes.caustic.empty()) by_band.push_back(&caustic);
    allocate_planes(by_band, planes.direct.size());
    own_share.resize(planes.pixels());
  }

  void take(const SimilarPixels& means, const StillPlanes& planes, const StillImage& image, int first,
            int last) {
    const std::size_t n = planes.pixels();
    const std::size_t start = planes.at(0, first);
    const std::size_t count = planes.at(0, last) - start;
    for (std::size_t p = 0; p < count; ++p) {
      own_share[start + p] = means.own_share(p);
      for (std::size_t b = 0; b < planes.bands; ++b) {
        const std::size_t at = b * n + start + p;
        const std::size_t k = (start + p) * planes.bands + b;
        const float scale = planes.scale[at];
        for (std::size_t h = 0; h < 2; ++h) irradiance[h][at] = means.mean(h, 0, b, p);
        direct[at] = means.mean_of_both(1, b, p);
        if (!caustic.empty()) caustic[at] = means.mean_of_both(2, b, p);
        radiance.variance[k] = scale * scale * means.variance(b, p);
        radiance.covariance[k] = own_share[start + p] * image.radiance_stderr[k] * image.radiance_stderr[k];
      }
    }
  }

  /// By band, as those of StillPlanes.
  std::array<std::vector<float>, 2> irradiance;
  std::vector<float> direct, caustic;
  std::vector<float> own_share;  ///< Of a pixel's own value in its mean.
  SmoothedValues radiance{0};  ///< In the layout of StillImage; of the values take() finds the errors alone.
};

/// Radiance of the irradiance that the planes hold.
void put_radiance(const StillPlanes& planes, SmoothedValues& radiance) {
  const std::size_t n = planes.pixels();
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t b = 0; b < planes.bands; ++b) {
      const std::size_t at = b * n + p;
      const std::size_t k = p * planes.bands + b;
      const float first = planes.irradiance[0][at];
      const float second = planes.irradiance[1][at];
      radiance.value[k] = 0.5F * planes.scale[at] * (first + second);
      radiance.halves_apart[k] = 0.5F * planes.scale[at] * (first - second);
    }
}

/// Layers that together are the picture, though each was averaged by itself.
void put_layers(const StillPlanes& planes, const std::vector<float>& radiance, StillImage& image) {
  const std::size_t n = planes.pixels();
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t b = 0; b < planes.bands; ++b) {
      const std::size_t at = b * n + p;
      const std::size_t k = p * planes.bands + b;
      float rest = radiance[k];
      image.direct[k] = std::min(planes.scale[at] * planes.direct[at], rest);
      rest -= image.direct[k];
      if (!image.caustic.empty()) {
        image.caustic[k] = std::min(planes.scale[at] * planes.caustic[at], rest);
        rest -= image.caustic[k];
      }
      image.indirect[k] = rest;
    }
}

/// The pixels of the block that begins at (x0,y0).
std::vector<std::size_t> pixels_of_block(const StillImage& image, int x0, int y0) {
  std::vector<std::size_t> pixels;
  for (int y = y0; y < std::min(image.height, y0 + kBlock); ++y)
    for (int x = x0; x < std::min(image.width, x0 + kBlock); ++x)
      pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x));
  return pixels;
}

/// A mean takes irradiance from other pixels, but reflectance from this one alone, with the noise of which
/// parts of edges and textures its samples met. Of its own radiance, whose share in the mean is s, that noise
/// is counted already, and reflectance and radiance share it: (1-s)^2 + 2 s (1-s) = 1 - s^2 is left.
void add_noise_of_albedo(const StillPlanes& planes, const StillImage& image,
                         const std::vector<float>& own_share, std::size_t band, SmoothedValues& smoothed) {
  for (std::size_t p = 0; p < planes.pixels(); ++p) {
    const std::size_t k = p * planes.bands + band;
    const float scale = planes.scale[band * planes.pixels() + p];
    if (image.albedo[k] < scale) continue;  // divided by something else
    const float noise = smoothed.value[k] * image.albedo_stderr[k] / scale;
    smoothed.variance[k] += (1 - own_share[p] * own_share[p]) * noise * noise;
    smoothed.covariance[k] += (1 - own_share[p]) * noise * noise;
  }
}

/// Completes the variances of a band; returns the relative error, rms over the picture.
double complete_errors(const StillPlanes& planes, const StillImage& image, SmoothedLayers& layers,
                       std::size_t band, double error_floor) {
  SmoothedValues& smoothed = layers.radiance;
  const std::size_t bands = image.bands.count();
  const std::vector<double> scales = relative_scales(smoothed.value, bands, band, error_floor);
  SmoothingErrors errors(smoothed, image.radiance, image.radiance_stderr, bands, band, scales);
  add_noise_of_albedo(planes, image, layers.own_share, band, smoothed);
  for (int y0 = 0; y0 < image.height; y0 += kBlock)
    for (int x0 = 0; x0 < image.width; x0 += kBlock) errors.complete(pixels_of_block(image, x0, y0));
  double squares = 0;
  for (std::size_t p = 0; p < scales.size(); ++p)
    squares += static_cast<double>(smoothed.variance[p * bands + band]) * scales[p] * scales[p];
  return std::sqrt(squares / static_cast<double>(image.pixel_count()));
}

}  // namespace

void smooth_still(StillImage& image, const StillHalves& halves, double error_floor, const StopToken& stop) {
  if (image.radiance_stderr.empty()) return;
  try {
    StillPlanes planes(image, halves);
    const LayerTotals sampled(planes);
    SmoothedLayers smoothed(planes);
    {
      const BasicEstimate basic(planes, stop);
      for_similar_pixels(planes, basic.guide(), SimilarPixels::Extent::kWide, kSmoothedRows, stop,
                         [&](const SimilarPixels& means, int first, int last) {
                           smoothed.take(means, planes, image, first, last);
                         });
    }
    if (stop.requested()) return;
    planes.irradiance = std::move(smoothed.irradiance);
    planes.direct = std::move(smoothed.direct);
    planes.caustic = std::move(smoothed.caustic);
    if (!planes.caustic.empty()) smooth_coarsely(planes, stop);
    if (stop.requested()) return;
    sampled.give_back_to(planes);
    put_radiance(planes, smoothed.radiance);
    std::vector<double> errors(image.bands.count());  // by band
    tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t b) {
      errors[b] = complete_errors(planes, image, smoothed, b, error_floor);
    });
    image.info.error = *std::max_element(errors.begin(), errors.end());
    std::transform(smoothed.radiance.variance.begin(), smoothed.radiance.variance.end(),
                   image.radiance_stderr.begin(), [](float variance) { return std::sqrt(variance); });
    put_layers(planes, smoothed.radiance.value, image);
    image.smoothed = true;
    image.radiance = std::move(smoothed.radiance.value);
  } catch (const std::bad_alloc&) {
    throw ResourceError("still", "out of memory to smooth " + std::to_string(image.pixel_count()) + " pixels",
                        "Choose a smaller picture, or do not smooth it.");
  }
}

}  // namespace reemit
