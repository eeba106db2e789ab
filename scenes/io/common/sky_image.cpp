#include "scenes/io/common/sky_image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/images/image_library.h"
#include "scenes/model/colour.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "scenes/model/upsampling.h"

namespace reemit {
namespace {

constexpr int kLeastRows = 8;
constexpr int kMostRowsRead = 1 << 14;
constexpr int kMostChannels = 1024;
constexpr int kMostRowsKept = 1 << 11;
/// Of a spectral image.
constexpr double kMostValues = 1 << 26;

/// Rows of linear RGB.
struct Pixels {
  int rows = 0, columns = 0;
  std::vector<float> rgb;
};

Pixels load_pixels(const std::filesystem::path& file) {
  check_readable_file(file);
  const std::string name = file.string();
  const auto unreadable = [&](const std::string& reason) {
    return InputError(name, "it cannot be read as an image: " + reason,
                      "Give a complete latitude-longitude image as .hdr or .exr.");
  };
  const OpenedImage opened = image_library().open(name);
  if (!opened.reader) throw unreadable(opened.problem);
  const auto [columns, rows, channels, is_float, rows_together] = opened.reader->layout();
  if (rows < kLeastRows || columns != 2 * rows || channels < 1)
    throw InputError(
        name, fmt::format("{} x {} pixels are no latitude-longitude image of the sky", columns, rows),
        fmt::format("It must be twice as wide as high, and at least {} x {}.", 2 * kLeastRows, kLeastRows));
  if (rows > kMostRowsRead || channels > kMostChannels)
    throw InputError(
        name, fmt::format("{} x {} pixels of {} values are too many", columns, rows, channels),
        fmt::format("Make it {} x {} or smaller, of red, green and blue.", 2 * kMostRowsRead, kMostRowsRead));
  if (!is_float)
    throw InputError(name, "its pixels are whole numbers, which cannot hold the range of a sky",
                     "Give an image of floating-point values: .hdr or .exr.");
  const int used = channels >= 3 ? 3 : 1;
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  std::vector<float> values(count * static_cast<std::size_t>(used));
  if (!opened.reader->read_image(used, values.data())) throw unreadable(opened.reader->take_message());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0 && std::isfinite(values[i])) continue;
    const std::size_t pixel = i / static_cast<std::size_t>(used);
    throw InputError(name,
                     fmt::format("pixel ({}, {}) has the value {}", pixel % static_cast<std::size_t>(columns),
                                 pixel / static_cast<std::size_t>(columns), values[i]),
                     "Radiance is a finite number of 0 or more: repair the image.");
  }
  Pixels pixels{rows, columns, std::move(values)};
  if (used == 3) return pixels;
  std::vector<float> grey = std::move(pixels.rgb);
  pixels.rgb.resize(3 * count);
  for (std::size_t i = 0; i < pixels.rgb.size(); ++i) pixels.rgb[i] = grey[i / 3];
  return pixels;
}

/// Means over squares of so many pixels, each counted by its solid angle.
Pixels shrunk(const Pixels& pixels, int factor) {
  Pixels small{pixels.rows / factor, pixels.columns / factor, {}};
  small.rgb.assign(static_cast<std::size_t>(small.rows) * static_cast<std::size_t>(small.columns) * 3, 0.0F);
  for (int row = 0; row < small.rows; ++row) {
    double total = 0;
    std::vector<double> sum(static_cast<std::size_t>(small.columns) * 3, 0.0);
    for (int r = row * factor; r < (row + 1) * factor; ++r) {
      const double weight = std::sin(std::numbers::pi * (r + 0.5) / pixels.rows);
      total += weight * factor;
      const float* from =
          &pixels.rgb[static_cast<std::size_t>(r) * static_cast<std::size_t>(pixels.columns) * 3];
      for (std::size_t x = 0; x < static_cast<std::size_t>(small.columns * factor); ++x)
        for (std::size_t c = 0; c < 3; ++c)
          sum[x / static_cast<std::size_t>(factor) * 3 + c] += weight * static_cast<double>(from[3 * x + c]);
    }
    std::transform(sum.begin(), sum.end(), small.rgb.begin() + static_cast<std::ptrdiff_t>(sum.size()) * row,
                   [&](double s) { return static_cast<float>(s / total); });
  }
  return small;
}

/// The pixel that stands in a column once the picture has been turned.
std::size_t turned(std::size_t column, double rotation_deg, std::size_t columns) {
  const auto n = static_cast<double>(columns);
  const double from = std::floor(static_cast<double>(column) - std::round(rotation_deg / 360 * n));
  return static_cast<std::size_t>(from - n * std::floor(from / n)) % columns;
}

Pixels shrunk_to(Pixels pixels, int most_rows) {
  int factor = 1;
  while (pixels.rows / factor > most_rows) ++factor;
  return factor > 1 ? shrunk(pixels, factor) : pixels;
}

}  // namespace

std::shared_ptr<const SkyImage> spectral_sky_image(const SkyImage& image, const ColourSpectra& spectra,
                                                   const Spectrum& white) {
  const std::size_t from_bands = image.radiance.size() / (image.rows * image.columns);
  Pixels rgb{static_cast<int>(image.rows), static_cast<int>(image.columns), image.radiance};
  if (from_bands == 1) {
    rgb.rgb.resize(3 * image.radiance.size());
    for (std::size_t i = 0; i < rgb.rgb.size(); ++i) rgb.rgb[i] = image.radiance[i / 3];
  }
  const std::size_t bands = spectra.band_count();
  const double most_rows = std::sqrt(kMostValues / (2 * static_cast<double>(bands)));
  rgb = shrunk_to(std::move(rgb), std::max(kLeastRows, static_cast<int>(most_rows)));
  auto result = std::make_shared<SkyImage>();
  result->rows = static_cast<std::size_t>(rgb.rows);
  result->columns = static_cast<std::size_t>(rgb.columns);
  result->radiance.resize(result->rows * result->columns * bands);
  for (std::size_t i = 0; i < result->rows * result->columns; ++i) {
    const float* from = &rgb.rgb[3 * i];
    // At most half of saturated.
    const float top = 2 * std::max({from[0], from[1], from[2]});
    if (!(top > 0)) continue;
    const std::span<float> to(&result->radiance[i * bands], bands);
    spectra.values({from[0] / top, from[1] / top, from[2] / top}, to);
    for (std::size_t b = 0; b < bands; ++b)
      to[b] *= top * static_cast<float>(white[static_cast<Eigen::Index>(b)]);
  }
  return result;
}

std::shared_ptr<const SkyImage> read_sky_image(const std::filesystem::path& file, double scale,
                                               double rotation_deg, const BandSet& bands) {
  const Pixels pixels = shrunk_to(load_pixels(file), kMostRowsKept);
  auto image = std::make_shared<SkyImage>();
  image->rows = static_cast<std::size_t>(pixels.rows);
  image->columns = static_cast<std::size_t>(pixels.columns);
  const std::size_t count = bands.kind() == BandKind::kGrey ? 1 : 3;
  const Eigen::Array3d weights = rec709_luminance_weights();
  image->radiance.resize(image->rows * image->columns * count);
  double greatest = 0;
  for (std::size_t row = 0; row < image->rows; ++row)
    for (std::size_t column = 0; column < image->columns; ++column) {
      const float* from =
          &pixels.rgb[3 * (row * image->columns + turned(column, rotation_deg, image->columns))];
      float* to = &image->radiance[(row * image->columns + column) * count];
      const Eigen::Array3d rgb =
          scale * Eigen::Array3d(static_cast<double>(from[0]), static_cast<double>(from[1]),
                                 static_cast<double>(from[2]));
      const double grey = (weights * rgb).sum();
      for (std::size_t b = 0; b < count; ++b) {
        const double value = count == 1 ? grey : rgb[static_cast<Eigen::Index>(b)];
        greatest = std::max(greatest, value);
        to[b] = static_cast<float>(value);
      }
    }
  if (!(greatest > 0))
    throw InputError(file.string(), "the image of the sky is black", "Give it light, or leave it out.");
  const std::string problem =
      strength_problem(Spectrum::Constant(1, greatest), "the radiance of a pixel [W/(m2 sr)]");
  if (!problem.empty()) throw InputError(file.string(), problem, kStrengthAdvice);
  if (bands.kind() != BandKind::kSpectral) return image;
  const Upsampling upsampling(bands);
  return spectral_sky_image(*image, ColourSpectra(upsampling, bands.count()),
                            upsampling.emission(Eigen::Array3d::Ones()).values);
}

}  // namespace reemit
