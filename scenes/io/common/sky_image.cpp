#include "scenes/io/common/sky_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// Makes latitude-longitude pixels fewer: means over what each has of the old ones, counted by solid angle.
/// Takes them row by row, so that large images are never in memory as a whole.
class RowAverager {
 public:
  /// Pre: 1 <= kept <= rows; the image has twice as many columns as rows, before and after.
  RowAverager(int rows, int kept) : rows_(rows), kept_(kept), sum_(row_size(kept), 0.0) {
    pixels_.rows = kept;
    pixels_.columns = 2 * kept;
    pixels_.rgb.reserve(static_cast<std::size_t>(kept) * row_size(kept));
    for (std::int64_t x = 0; x < 2 * std::int64_t{rows}; ++x) columns_.push_back(divided(x));
  }

  /// The next row from the top: 3 values for each of 2 * rows columns.
  void add(std::span<const float> rgb) {
    if (kept_ == rows_) {
      pixels_.rgb.insert(pixels_.rgb.end(), rgb.begin(), rgb.end());
      return;
    }
    const Division row = divided(next_);
    const double weight = std::sin(std::numbers::pi * (static_cast<double>(next_) + 0.5) / rows_);
    add(rgb, weight * row.share);
    ++next_;
    if (!row.ends) return;
    // Columns of one new pixel add up to this many old ones.
    const double total = weight_ * rows_ / kept_;
    for (double& s : sum_) {
      pixels_.rgb.push_back(static_cast<float>(s / total));
      s = 0;
    }
    weight_ = 0;
    if (row.share < 1) add(rgb, weight * (1 - row.share));
  }

  Pixels take() { return std::move(pixels_); }

 private:
  /// Of an old row or column: the new one in which it begins, how much of it lies there, and whether that one
  /// ends there. The rest lies in the next.
  struct Division {
    std::size_t part;
    double share;
    bool ends;
  };
  Division divided(std::int64_t i) const {
    const std::int64_t begin = i * kept_, end = begin + kept_;
    const std::int64_t part = begin / rows_;
    const std::int64_t edge = (part + 1) * rows_;
    return {static_cast<std::size_t>(part), static_cast<double>(std::min(end, edge) - begin) / kept_,
            end >= edge};
  }
  static std::size_t row_size(int rows) { return 6 * static_cast<std::size_t>(rows); }

  void add(std::span<const float> rgb, double weight) {
    weight_ += weight;
    for (std::size_t x = 0; x < columns_.size(); ++x) {
      const auto [part, share, ends] = columns_[x];
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = weight * static_cast<double>(rgb[3 * x + c]);
        sum_[3 * part + c] += share * value;
        if (share < 1) sum_[3 * (part + 1) + c] += (1 - share) * value;
      }
    }
  }

  std::int64_t rows_, kept_;
  std::int64_t next_ = 0;
  std::vector<Division> columns_;
  std::vector<double> sum_;  // of the new row that is being made
  double weight_ = 0;        // of the parts of old rows in it
  Pixels pixels_;
};

/// Reads an image, with at most so many rows kept.
Pixels load_pixels(const std::filesystem::path& file, int most_rows) {
  check_readable_file(file);
  const std::string name = file.string();
  const auto unreadable = [&](const std::string& reason) {
    return InputError(name, "it cannot be read as an image: " + reason,
                      "Give a complete latitude-longitude image as .hdr or .exr.");
  };
  const OpenedImage opened = image_library().open(name);
  if (!opened.reader) throw unreadable(opened.problem);
  const ImageLayout layout = opened.reader->layout();
  const int rows = layout.height, columns = layout.width, channels = layout.channels;
  if (rows < kLeastRows || columns != 2 * rows || channels < 1)
    throw InputError(
        name, fmt::format("{} x {} pixels are no latitude-longitude image of the sky", columns, rows),
        fmt::format("It must be twice as wide as high, and at least {} x {}.", 2 * kLeastRows, kLeastRows));
  if (rows > kMostRowsRead || channels > kMostChannels)
    throw InputError(
        name, fmt::format("{} x {} pixels of {} values are too many", columns, rows, channels),
        fmt::format("Make it {} x {} or smaller, of red, green and blue.", 2 * kMostRowsRead, kMostRowsRead));
  if (!layout.is_float)
    throw InputError(name, "its pixels are whole numbers, which cannot hold the range of a sky",
                     "Give an image of floating-point values: .hdr or .exr.");
  const auto width = static_cast<std::size_t>(columns), values = static_cast<std::size_t>(channels);
  std::vector<float> block(width * values * static_cast<std::size_t>(layout.rows_together));
  std::vector<float> rgb(3 * width);
  RowAverager averager(rows, std::min(rows, most_rows));
  for (int row = 0; row < rows; ++row) {
    const int in_block = row % layout.rows_together;
    if (in_block == 0 && !opened.reader->read_rows(row, std::min(row + layout.rows_together, rows),
                                                   PixelType::kFloat, block.data()))
      throw unreadable(opened.reader->take_message());
    const float* from = &block[width * values * static_cast<std::size_t>(in_block)];
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      rgb[i] = from[i / 3 * values + (channels >= 3 ? i % 3 : 0)];
      if (!(rgb[i] >= 0 && std::isfinite(rgb[i])))
        throw InputError(name, fmt::format("pixel ({}, {}) has the value {}", i / 3, row, rgb[i]),
                         "Radiance is a finite number of 0 or more: repair the image.");
    }
    averager.add(rgb);
  }
  return averager.take();
}

/// The pixel that stands in a column once the picture has been turned.
std::size_t turned(std::size_t column, double rotation_deg, std::size_t columns) {
  const auto n = static_cast<double>(columns);
  const double from = std::floor(static_cast<double>(column) - std::round(rotation_deg / 360 * n));
  return static_cast<std::size_t>(from - n * std::floor(from / n)) % columns;
}

Pixels shrunk_to(Pixels pixels, int most_rows) {
  if (pixels.rows <= most_rows) return pixels;
  RowAverager averager(pixels.rows, most_rows);
  const std::size_t size = 3 * static_cast<std::size_t>(pixels.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(pixels.rows); ++row)
    averager.add(std::span(pixels.rgb).subspan(row * size, size));
  return averager.take();
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
  const Pixels pixels = load_pixels(file, kMostRowsKept);
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
