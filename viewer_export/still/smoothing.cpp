#include "viewer_export/still/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "scenes/model/error.h"
#include "viewer_export/output/smoothing_errors.h"
#include "viewer_export/still/coarse_smoothing.h"
#include "viewer_export/still/similar_pixels.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {
namespace {

constexpr int kStripe = 16;  ///< Rows that are averaged in one go.
constexpr int kBlock = 16;   ///< Pixels to a side of a block.

/// What a picture becomes, in the layout of StillImage.
struct SmoothedLayers {
  SmoothedLayers(const StillImage& image, const StillPlanes& planes)
      : irradiance{planes.irradiance, planes.direct, planes.caustic},
        radiance(image.radiance.size()),
        direct(image.radiance.size()),
        caustic(image.caustic.size()) {}

  void take(const SimilarPixels& stripe, const StillPlanes& planes, const StillImage& image, int first,
            int last) {
    const std::size_t n = planes.pixels();
    const std::size_t start = planes.at(0, first);
    const std::size_t count = planes.at(0, last) - start;
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t b = 0; b < planes.bands; ++b) {
        const std::size_t from = b * n + start + p;
        const std::size_t k = (start + p) * planes.bands + b;
        const float scale = planes.scale[from];
        const auto both = [&](std::size_t layer) {
          return 0.5F * (stripe.mean(0, layer, b, p) + stripe.mean(1, layer, b, p));
        };
        for (std::size_t h = 0; h < 2; ++h) irradiance.halves[h][from] = stripe.mean(h, 0, b, p);
        irradiance.direct[from] = both(1);
        if (!caustic.empty()) irradiance.caustic[from] = both(2);
        radiance.variance[k] = scale * scale * stripe.variance(b, p);
        radiance.covariance[k] = stripe.own_share(p) * image.radiance_stderr[k] * image.radiance_stderr[k];
      }
    }
  }

  /// Radiance of the irradiance.
  void finish(const StillPlanes& planes) {
    const std::size_t n = planes.pixels();
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t b = 0; b < planes.bands; ++b) {
        const std::size_t from = b * n + p;
        const std::size_t k = p * planes.bands + b;
        const float scale = planes.scale[from];
        const float first = irradiance.halves[0][from];
        const float second = irradiance.halves[1][from];
        radiance.value[k] = 0.5F * scale * (first + second);
        radiance.halves_apart[k] = 0.5F * scale * (first - second);
        direct[k] = scale * irradiance.direct[from];
        if (!caustic.empty()) caustic[k] = scale * irradiance.caustic[from];
      }
  }

  SmoothedIrradiance irradiance;
  SmoothedValues radiance;
  std::vector<float> direct, caustic;
};

/// The pixels of the block that begins at (x0,y0).
std::vector<std::size_t> pixels_of_block(const StillImage& image, int x0, int y0) {
  std::vector<std::size_t> pixels;
  for (int y = y0; y < std::min(image.height, y0 + kBlock); ++y)
    for (int x = x0; x < std::min(image.width, x0 + kBlock); ++x)
      pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x));
  return pixels;
}

/// Completes the variances of a band; returns the relative error, rms over the picture.
double complete_errors(const StillImage& image, SmoothedValues& smoothed, std::size_t band,
                       double error_floor) {
  const std::size_t bands = image.bands.count();
  const std::vector<double> scales = relative_scales(smoothed.value, bands, band, error_floor);
  SmoothingErrors errors(smoothed, bands, band, scales);
  for (int y0 = 0; y0 < image.height; y0 += kBlock)
    for (int x0 = 0; x0 < image.width; x0 += kBlock)
      errors.complete(pixels_of_block(image, x0, y0), image.radiance, image.radiance_stderr);
  double squares = 0;
  for (std::size_t p = 0; p < scales.size(); ++p)
    squares += static_cast<double>(smoothed.variance[p * bands + band]) * scales[p] * scales[p];
  return std::sqrt(squares / static_cast<double>(image.pixel_count()));
}

}  // namespace

void smooth_still(StillImage& image, const StillHalves& halves, double error_floor, const StopToken& stop) {
  if (image.radiance_stderr.empty()) return;
  try {
    const StillPlanes planes(image, halves);
    SmoothedLayers smoothed(image, planes);
    const int stripes = (image.height + kStripe - 1) / kStripe;
    tbb::parallel_for(0, stripes, [&](int s) {
      if (stop.requested()) return;
      const int first = s * kStripe;
      const int last = std::min(image.height, first + kStripe);
      SimilarPixels stripe(planes, first, last);
      stripe.average();
      smoothed.take(stripe, planes, image, first, last);
    });
    if (!planes.caustic.empty()) smooth_coarsely(planes, stop, smoothed.irradiance);
    if (stop.requested()) return;
    smoothed.finish(planes);
    image.info.error = 0;
    for (std::size_t b = 0; b < image.bands.count(); ++b)
      image.info.error =
          std::max(image.info.error, complete_errors(image, smoothed.radiance, b, error_floor));
    for (std::size_t k = 0; k < image.radiance.size(); ++k) {
      // Each layer has been bounded by itself; together they are the picture.
      smoothed.direct[k] = std::min(smoothed.direct[k], smoothed.radiance.value[k]);
      float rest = smoothed.radiance.value[k] - smoothed.direct[k];
      if (!image.caustic.empty()) {
        smoothed.caustic[k] = std::min(smoothed.caustic[k], rest);
        rest -= smoothed.caustic[k];
      }
      image.indirect[k] = rest;
      image.radiance_stderr[k] = std::sqrt(smoothed.radiance.variance[k]);
    }
    image.smoothed = true;
    image.radiance = std::move(smoothed.radiance.value);
    image.direct = std::move(smoothed.direct);
    image.caustic = std::move(smoothed.caustic);
  } catch (const std::bad_alloc&) {
    throw ResourceError("still", "out of memory to smooth " + std::to_string(image.pixel_count()) + " pixels",
                        "Choose a smaller picture, or do not smooth it.");
  }
}

}  // namespace reemit
