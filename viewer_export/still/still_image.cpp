#include "viewer_export/still/still_image.h"

#include <stdexcept>

namespace reemit {

void check_consistent(const StillImage& image) {
  if (image.width <= 0 || image.height <= 0) throw std::invalid_argument("still image without pixels");
  const std::size_t pixels = image.pixel_count();
  const std::size_t values = pixels * image.bands.count();
  const auto check = [](const std::vector<float>& layer, std::size_t size, bool may_be_empty) {
    if (layer.size() != size && !(may_be_empty && layer.empty()))
      throw std::invalid_argument("still image with a layer of the wrong size");
  };
  check(image.radiance, values, false);
  for (const auto* layer : {&image.direct, &image.indirect, &image.caustic, &image.radiance_stderr,
                            &image.albedo, &image.albedo_stderr})
    check(*layer, values, true);
  check(image.samples, pixels, true);
  check(image.luminous, pixels, true);
  check(image.mirroring, pixels, true);
  check(image.depth, pixels, true);
  check(image.normal, 3 * pixels, true);
}

std::vector<double> relative_scales(const std::vector<float>& radiance, std::size_t bands, std::size_t band,
                                    double error_floor) {
  const std::size_t pixels = radiance.size() / bands;
  double mean = 0;
  for (std::size_t p = 0; p < pixels; ++p)
    mean += static_cast<double>(radiance[p * bands + band]) / static_cast<double>(pixels);
  std::vector<double> scales(pixels, 0.0);
  for (std::size_t p = 0; p < pixels; ++p) {
    const double seen = static_cast<double>(radiance[p * bands + band]) + error_floor * mean;
    if (seen > 0) scales[p] = 1 / seen;
  }
  return scales;
}

std::vector<float> rgb_of(const StillImage& image) {
  const std::size_t bands = image.bands.count();
  std::vector<float> rgb;
  rgb.reserve(3 * image.pixel_count());
  Spectrum value(static_cast<Eigen::Index>(bands));
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (std::size_t band = 0; band < bands; ++band)
      value[static_cast<Eigen::Index>(band)] = image.radiance[pixel * bands + band];
    for (const double c : image.bands.to_rgb(value)) rgb.push_back(static_cast<float>(c));
  }
  return rgb;
}

}  // namespace reemit
