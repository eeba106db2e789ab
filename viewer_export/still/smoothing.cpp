#include "viewer_export/still/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "scenes/model/error.h"
#include "viewer_export/still/similar_pixels.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {
namespace {

constexpr int kStripe = 16;  ///< Rows that are averaged in one go.
constexpr int kBlock = 16;   ///< Pixels to a side of a block.

/// What a picture becomes, in the layout of StillImage, and what its errors are made of.
struct Smoothed {
  explicit Smoothed(const StillImage& image)
      : radiance(image.radiance.size()),
        direct(image.radiance.size()),
        caustic(image.caustic.size()),
        variance(image.radiance.size()),
        halves_apart(image.radiance.size()),
        own_share(image.pixel_count()) {}

  void take(const SimilarPixels& stripe, const StillPlanes& planes, const StillImage& image, int first,
            int last) {
    const std::size_t n = planes.pixels();
    const std::size_t start = planes.at(0, first);
    const std::size_t count = planes.at(0, last) - start;
    for (std::size_t p = 0; p < count; ++p) {
      own_share[start + p] = stripe.own_share(p);
      for (std::size_t b = 0; b < planes.bands; ++b) {
        const std::size_t k = (start + p) * planes.bands + b;
        const float scale = planes.scale[b * n + start + p];
        const auto both = [&](std::size_t layer) {
          return 0.5F * scale * (stripe.mean(0, layer, b, p) + stripe.mean(1, layer, b, p));
        };
        radiance[k] = both(0);
        direct[k] = both(1);
        if (!image.caustic.empty()) caustic[k] = both(2);
        variance[k] = scale * scale * stripe.variance(b, p);
        halves_apart[k] = 0.5F * scale * (stripe.mean(0, 0, b, p) - stripe.mean(1, 0, b, p));
      }
    }
  }

  std::vector<float> radiance, direct, caustic;
  std::vector<float> variance;      // of noise that pixels do not share
  std::vector<float> halves_apart;  // half the difference of the halves
  std::vector<float> own_share;     // by pixel
};

/// Relative weights of pixels: 1 / (L + floor).
std::vector<double> pixel_scales(const Smoothed& smoothed, std::size_t bands, std::size_t band,
                                 double error_floor) {
  const std::size_t pixels = smoothed.own_share.size();
  double mean = 0;
  for (std::size_t p = 0; p < pixels; ++p)
    mean += static_cast<double>(smoothed.radiance[p * bands + band]) / static_cast<double>(pixels);
  std::vector<double> scales(pixels, 0.0);
  for (std::size_t p = 0; p < pixels; ++p) {
    const double radiance = static_cast<double>(smoothed.radiance[p * bands + band]) + error_floor * mean;
    if (radiance > 0) scales[p] = 1 / radiance;
  }
  return scales;
}

/// How much larger the variance of the smoothed halves is over the picture than pixels by themselves explain,
/// at least 1: noise that neighbours share does not average out.
double shared_noise(const Smoothed& smoothed, std::size_t bands, std::size_t band,
                    const std::vector<double>& scales) {
  double explained = 0;
  double found = 0;
  for (std::size_t p = 0; p < scales.size(); ++p) {
    const std::size_t k = p * bands + band;
    explained += static_cast<double>(smoothed.variance[k]) * scales[p] * scales[p];
    found += std::pow(static_cast<double>(smoothed.halves_apart[k]) * scales[p], 2);
  }
  return explained > 0 ? std::max(1.0, found / explained) : 1.0;
}

/// Calls do_pixel(index) for the pixels of the block that begins at (x0,y0).
template <class DoPixel>
void for_pixels_of_block(const StillImage& image, int x0, int y0, DoPixel&& do_pixel) {
  for (int y = y0; y < std::min(image.height, y0 + kBlock); ++y)
    for (int x = x0; x < std::min(image.width, x0 + kBlock); ++x)
      do_pixel(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(x));
}

/// Relative mean square by which the means of a block are off beyond noise; 0 where noise explains it.
double misplaced(const StillImage& image, const Smoothed& smoothed, std::size_t band,
                 const std::vector<double>& scales, int x0, int y0) {
  const std::size_t bands = image.bands.count();
  double sum = 0;
  double count = 0;
  for_pixels_of_block(image, x0, y0, [&](std::size_t p) {
    const std::size_t k = p * bands + band;
    const double scale = scales[p] * scales[p];
    const double noise = std::pow(static_cast<double>(image.radiance_stderr[k]), 2);
    const double off = static_cast<double>(smoothed.radiance[k]) - static_cast<double>(image.radiance[k]);
    const double expected = noise * (1 - 2 * static_cast<double>(smoothed.own_share[p])) +
                            static_cast<double>(smoothed.variance[k]);
    sum += scale * (off * off - expected);
    ++count;
  });
  return std::max(0.0, sum / count);
}

/// Adds to the variances of a band what pixels share and what means are off; returns the relative error, rms
/// over the picture.
double complete_errors(const StillImage& image, Smoothed& smoothed, std::size_t band, double error_floor) {
  const std::size_t bands = image.bands.count();
  const std::vector<double> scales = pixel_scales(smoothed, bands, band, error_floor);
  const double shared = shared_noise(smoothed, bands, band, scales);
  double squares = 0;
  for (int y0 = 0; y0 < image.height; y0 += kBlock)
    for (int x0 = 0; x0 < image.width; x0 += kBlock) {
      const double off = misplaced(image, smoothed, band, scales, x0, y0);
      for_pixels_of_block(image, x0, y0, [&](std::size_t p) {
        float& variance = smoothed.variance[p * bands + band];
        const double scale2 = scales[p] * scales[p];
        const double total = shared * static_cast<double>(variance) + (scale2 > 0 ? off / scale2 : 0);
        squares += total * scale2;
        variance = static_cast<float>(total);
      });
    }
  return std::sqrt(squares / static_cast<double>(image.pixel_count()));
}

}  // namespace

void smooth_still(StillImage& image, const StillHalves& halves, double error_floor, const StopToken& stop) {
  if (image.radiance_stderr.empty()) return;
  try {
    const StillPlanes planes(image, halves);
    Smoothed smoothed(image);
    const int stripes = (image.height + kStripe - 1) / kStripe;
    tbb::parallel_for(0, stripes, [&](int s) {
      if (stop.requested()) return;
      const int first = s * kStripe;
      const int last = std::min(image.height, first + kStripe);
      SimilarPixels stripe(planes, first, last);
      stripe.average();
      smoothed.take(stripe, planes, image, first, last);
    });
    if (stop.requested()) return;
    image.info.error = 0;
    for (std::size_t b = 0; b < image.bands.count(); ++b)
      image.info.error = std::max(image.info.error, complete_errors(image, smoothed, b, error_floor));
    for (std::size_t k = 0; k < image.radiance.size(); ++k) {
      const float caustic = image.caustic.empty() ? 0.0F : smoothed.caustic[k];
      image.indirect[k] = std::max(0.0F, smoothed.radiance[k] - smoothed.direct[k] - caustic);
      image.radiance_stderr[k] = std::sqrt(smoothed.variance[k]);
    }
    image.smoothed = true;
    image.info.settings.emplace_back("smoothed", "over pixels that are the same within their noise");
    image.radiance = std::move(smoothed.radiance);
    image.direct = std::move(smoothed.direct);
    image.caustic = std::move(smoothed.caustic);
  } catch (const std::bad_alloc&) {
    throw ResourceError("still", "out of memory to smooth " + std::to_string(image.pixel_count()) + " pixels",
                        "Choose a smaller picture, or do not smooth it.");
  }
}

}  // namespace reemit
