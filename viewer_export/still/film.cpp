#include "viewer_export/still/film.h"

#include <cmath>
#include <limits>
#include <new>

#include "scenes/model/error.h"

namespace reemit {

std::string to_string(PixelFilter filter) {
  return filter == PixelFilter::kBox ? "box" : "tent";
}

double sample_filter(PixelFilter filter, double u) {
  if (filter == PixelFilter::kBox) return u - 0.5;
  return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

std::size_t Film::bytes_per_pixel(std::size_t bands) {
  return (5 * bands + 7) * sizeof(float);
}

Film::Film(const BandSet& bands, int width, int height) : bands_(bands.count()) {
  image_.bands = bands;
  image_.width = width;
  image_.height = height;
  const std::size_t pixels = image_.pixel_count();
  try {
    for (auto* layer : {&image_.radiance, &image_.direct, &image_.radiance_stderr, &image_.albedo})
      layer->assign(pixels * bands_, 0.0F);
    image_.samples.assign(pixels, 0.0F);
    image_.depth.assign(pixels, 0.0F);
    image_.normal.assign(3 * pixels, 0.0F);
    seen_.assign(pixels, 0.0F);
    passes_.assign(pixels, 0.0F);
  } catch (const std::bad_alloc&) {
    throw ResourceError("still",
                        "out of memory for " + std::to_string(pixels) + " pixels of " +
                            std::to_string(bytes_per_pixel(bands_)) + " bytes",
                        "Choose a smaller picture.");
  }
}

void Film::add(std::size_t pixel, const PixelPass& pass) {
  const float n = ++passes_[pixel];
  for (std::size_t b = 0; b < bands_; ++b) {
    const std::size_t k = pixel * bands_ + b;
    // Running mean and sum of squared deviations [WEL62].
    const float value = pass.direct[b] + pass.indirect[b];
    const float deviation = value - image_.radiance[k];
    image_.radiance[k] += deviation / n;
    image_.radiance_stderr[k] += deviation * (value - image_.radiance[k]);
    image_.direct[k] += (pass.direct[b] - image_.direct[k]) / n;
    image_.albedo[k] += (pass.albedo[b] - image_.albedo[k]) / n;
  }
  image_.samples[pixel] += static_cast<float>(pass.samples);
  image_.depth[pixel] += static_cast<float>(pass.depth);
  for (std::size_t k = 0; k < 3; ++k)
    image_.normal[3 * pixel + k] += static_cast<float>(pass.normal[static_cast<Eigen::Index>(k)]);
  seen_[pixel] += static_cast<float>(pass.seen);
}

double Film::squared_error(std::size_t pixel, std::size_t band) const {
  const double n = passes_[pixel];
  if (n < 2) return std::numeric_limits<double>::infinity();
  return image_.radiance_stderr[pixel * bands_ + band] / (n * (n - 1));
}

StillImage Film::finish() {
  bool have_errors = true;
  for (const float n : passes_) have_errors = have_errors && n >= 2;
  image_.indirect.resize(image_.radiance.size());
  for (std::size_t pixel = 0; pixel < image_.pixel_count(); ++pixel) {
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t k = pixel * bands_ + b;
      image_.indirect[k] = std::max(0.0F, image_.radiance[k] - image_.direct[k]);
      if (have_errors) image_.radiance_stderr[k] = static_cast<float>(std::sqrt(squared_error(pixel, b)));
    }
    const float seen = seen_[pixel];
    image_.depth[pixel] = seen > 0 ? image_.depth[pixel] / seen : std::numeric_limits<float>::infinity();
    Eigen::Map<Vec3f> normal(&image_.normal[3 * pixel]);
    const float length = normal.norm();
    if (length > 0) normal /= length;
  }
  if (!have_errors) image_.radiance_stderr.clear();
  return std::move(image_);
}

}  // namespace reemit
