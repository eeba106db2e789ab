#include "scenes/io/common/sky_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <OpenImageIO/imagebuf.h>
#include <fmt/format.h>

#include "scenes/io/common/text_file.h"
#include "scenes/model/colour.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

constexpr int kLeastRows = 8;
constexpr int kMostRowsRead = 1 << 14;
constexpr int kMostRowsKept = 1 << 11;

/// Rows of linear RGB.
struct Pixels {
  int rows = 0, columns = 0;
  std::vector<float> rgb;
};

Pixels load_pixels(const std::filesystem::path& file) {
  check_readable_file(file);
  const std::string name = file.string();
  OIIO::ImageBuf image(name);
  if (!image.init_spec(name, 0, 0) || image.nchannels() < 1)
    throw InputError(name, "it cannot be read as an image: " + image.geterror(),
                     "Give a latitude-longitude image as .hdr or .exr.");
  const int columns = image.spec().width;
  const int rows = image.spec().height;
  if (rows < kLeastRows || columns != 2 * rows)
    throw InputError(
        name, fmt::format("{} x {} pixels are no latitude-longitude image of the sky", columns, rows),
        fmt::format("It must be twice as wide as high, and at least {} x {}.", 2 * kLeastRows, kLeastRows));
  if (rows > kMostRowsRead)
    throw InputError(name, fmt::format("{} x {} pixels are too many", columns, rows),
                     fmt::format("Make it {} x {} or smaller.", 2 * kMostRowsRead, kMostRowsRead));
  if (!image.nativespec().format.is_floating_point())
    throw InputError(name, "its pixels are whole numbers, which cannot hold the range of a sky",
                     "Give an image of floating-point values: .hdr or .exr.");
  if (!image.read(0, 0, /*force*/ true, OIIO::TypeDesc::FLOAT))
    throw InputError(name, "it cannot be read as an image: " + image.geterror(), "Is the file complete?");
  Pixels pixels{rows, columns,
                std::vector<float>(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) * 3)};
  const int channels = image.nchannels() >= 3 ? 3 : 1;
  const int x0 = image.spec().x;
  const int y0 = image.spec().y;
  for (OIIO::ImageBuf::ConstIterator<float> p(image); !p.done(); ++p) {
    const auto at = static_cast<std::size_t>(p.y() - y0) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(p.x() - x0);
    for (int c = 0; c < 3; ++c) {
      const float value = p[std::min(c, channels - 1)];
      if (!(value >= 0) || !std::isfinite(value))
        throw InputError(name, fmt::format("pixel ({}, {}) has the value {}", p.x() - x0, p.y() - y0, value),
                         "Radiance is a finite number of 0 or more: repair the image.");
      pixels.rgb[3 * at + static_cast<std::size_t>(c)] = value;
    }
  }
  if (image.has_error())
    throw InputError(name, "it cannot be read as an image: " + image.geterror(), "Is the file complete?");
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

}  // namespace

std::shared_ptr<const SkyImage> read_sky_image(const std::filesystem::path& file, double scale,
                                               double rotation_deg, const BandSet& bands) {
  Pixels pixels = load_pixels(file);
  int factor = 1;
  while (pixels.rows / factor > kMostRowsKept) ++factor;
  if (factor > 1) pixels = shrunk(pixels, factor);
  auto image = std::make_shared<SkyImage>();
  image->rows = static_cast<std::size_t>(pixels.rows);
  image->columns = static_cast<std::size_t>(pixels.columns);
  const std::size_t count = bands.count();
  const Eigen::Array3d weights = rec709_luminance_weights();
  image->radiance.resize(image->rows * image->columns * count);
  // Equal radiance in all bands of a spectral room that has the luminance of the colour.
  const double spectral = bands.efficacy_lm_per_w().sum() > 0 ? 179 / bands.efficacy_lm_per_w().sum() : 0;
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
        const double value = bands.kind() == BandKind::kRgb    ? rgb[static_cast<Eigen::Index>(b)]
                             : bands.kind() == BandKind::kGrey ? grey
                                                               : spectral * grey;
        greatest = std::max(greatest, value);
        to[b] = static_cast<float>(value);
      }
    }
  if (!(greatest > 0))
    throw InputError(file.string(), "the image of the sky is black", "Give it light, or leave it out.");
  const std::string problem =
      strength_problem(Spectrum::Constant(1, greatest), "the radiance of a pixel [W/(m2 sr)]");
  if (!problem.empty()) throw InputError(file.string(), problem, kStrengthAdvice);
  return image;
}

}  // namespace reemit
