#include "bench/many_luminaires/side_by_side.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "viewer_export/output/tone_map.h"

namespace reemit::bench {
namespace {

constexpr int kEnlarged = 4;  // a crop's pixel, on each side
constexpr int kGap = 4;       // [px] between pictures
constexpr float kFrames[2][3] = {{1, 0.65F, 0}, {0.35F, 0.8F, 1}};

/// Encoded sRGB in [0,1].
OIIO::ImageBuf shown(const DirectPicture& picture, const ToneMap& tone_map) {
  const std::vector<float> rgb = picture.sum();
  std::vector<std::uint8_t> bytes;
  bytes.reserve(rgb.size());
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const Eigen::Array3d mapped = tone_map({rgb[i], rgb[i + 1], rgb[i + 2]});
    for (const double c : mapped) bytes.push_back(srgb_byte(c));
  }
  const OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf buffer(spec);
  if (!buffer.set_pixels(OIIO::get_roi(spec), OIIO::TypeDesc::UINT8, bytes.data()))
    throw std::runtime_error(buffer.geterror());
  return buffer;
}

struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Squared differences between what is shown, summed over channels, per pixel.
std::vector<double> squared_differences(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b) {
  const auto read = [](const OIIO::ImageBuf& image) {
    std::vector<float> values(3 * image.spec().image_pixels());
    if (!image.get_pixels(OIIO::get_roi(image.spec()), OIIO::TypeDesc::FLOAT, values.data()))
      throw std::runtime_error(image.geterror());
    return values;
  };
  const std::vector<float> of_a = read(a);
  const std::vector<float> of_b = read(b);
  std::vector<double> squares(of_a.size() / 3);
  for (std::size_t i = 0; i < of_a.size(); ++i)
    squares[i / 3] += std::pow(static_cast<double>(of_a[i]) - static_cast<double>(of_b[i]), 2);
  return squares;
}

/// The window of this size, among those a quarter of it apart, in which |sum of a - b| is largest.
Window most_different(const std::vector<double>& a, const std::vector<double>& b, int width, int height) {
  Window best{0, 0, width / kEnlarged, height / kEnlarged};
  double largest = -1;
  for (int y = 0; y + best.height <= height; y += best.height / 4)
    for (int x = 0; x + best.width <= width; x += best.width / 4) {
      double sum = 0;
      for (int v = y; v < y + best.height; ++v)
        for (int u = x; u < x + best.width; ++u) {
          const auto i =
              static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
          sum += a[i] - b[i];
        }
      if (std::abs(sum) > largest) {
        largest = std::abs(sum);
        best.x = x;
        best.y = y;
      }
    }
  return best;
}

void require(bool done, const OIIO::ImageBuf& image) {
  if (!done) throw std::runtime_error(image.geterror());
}

OIIO::ImageBuf enlarged(const OIIO::ImageBuf& image, const Window& w) {
  const OIIO::ImageBuf cut = OIIO::ImageBufAlgo::cut(image, {w.x, w.x + w.width, w.y, w.y + w.height});
  const OIIO::ROI size(0, kEnlarged * w.width, 0, kEnlarged * w.height, 0, 1, 0, 3);
  return OIIO::ImageBufAlgo::resample(cut, false, size);
}

}  // namespace

void write_side_by_side(const std::vector<DirectPicture>& pictures, const std::filesystem::path& file) {
  if (pictures.size() != 4) throw std::invalid_argument("four pictures go side by side");
  const int width = pictures.back().width;
  const int height = pictures.back().height;
  const ToneMap tone_map = make_tone_map(pictures.back().sum());
  std::vector<OIIO::ImageBuf> images;
  for (const DirectPicture& p : pictures) images.push_back(shown(p, tone_map));

  std::vector<std::vector<double>> off;
  for (std::size_t i = 0; i < 3; ++i) off.push_back(squared_differences(images[i], images[3]));
  const Window windows[2] = {most_different(off[0], off[2], width, height),
                             most_different(off[1], off[2], width, height)};

  const int columns = static_cast<int>(images.size());
  const OIIO::ImageSpec spec(columns * width + (columns - 1) * kGap, 3 * height + 2 * kGap, 3,
                             OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf sheet(spec);
  constexpr float kWhite[3] = {1, 1, 1};
  require(OIIO::ImageBufAlgo::fill(sheet, kWhite), sheet);
  for (int i = 0; i < columns; ++i) {
    const OIIO::ImageBuf& image = images[static_cast<std::size_t>(i)];
    const int left = i * (width + kGap);
    require(OIIO::ImageBufAlgo::paste(sheet, left, 0, 0, 0, image), sheet);
    for (int k = 0; k < 2; ++k) {
      const Window& w = windows[k];
      require(OIIO::ImageBufAlgo::paste(sheet, left, (k + 1) * (height + kGap), 0, 0, enlarged(image, w)),
              sheet);
      require(OIIO::ImageBufAlgo::render_box(sheet, left + w.x, w.y, left + w.x + w.width - 1,
                                             w.y + w.height - 1, kFrames[k]),
              sheet);
    }
  }
  require(sheet.write(file.string()), sheet);
}

}  // namespace reemit::bench
