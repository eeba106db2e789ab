#include "scenes/io/common/texture_average.h"

#include <algorithm>
#include <cmath>

#include <OpenImageIO/imagebuf.h>

#include "scenes/io/common/text_file.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

double decode_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace

TextureAverage average_texture(const std::filesystem::path& file) {
  TextureAverage result;
  try {
    check_readable_file(file);
  } catch (const InputError& error) {
    result.problem = error.what();
    return result;
  }
  OIIO::ImageBuf image(file.string());
  constexpr double kMostPixels = 1 << 26;
  if (!image.init_spec(file.string(), 0, 0) || image.nchannels() < 1) {
    result.problem = "it cannot be read as an image: " + image.geterror();
    return result;
  }
  if (static_cast<double>(image.spec().width) * image.spec().height > kMostPixels) {
    result.problem = "the image is too large";
    return result;
  }
  const bool is_srgb = !image.nativespec().format.is_floating_point();
  if (!image.read(0, 0, /*force*/ true, OIIO::TypeDesc::FLOAT)) {
    result.problem = "it cannot be read as an image: " + image.geterror();
    return result;
  }
  const int channels = image.nchannels() >= 3 ? 3 : 1;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double pixels = 0;
  for (OIIO::ImageBuf::ConstIterator<float> pixel(image); !pixel.done(); ++pixel, ++pixels) {
    for (int c = 0; c < 3; ++c) {
      const double value = std::clamp(static_cast<double>(pixel[std::min(c, channels - 1)]), 0.0, 1.0);
      sum[c] += is_srgb ? decode_srgb(value) : value;
    }
  }
  if (image.has_error() || pixels == 0) {
    result.problem = "it cannot be read as an image: " + image.geterror();
    return result;
  }
  result.rgb = sum / pixels;
  return result;
}

}  // namespace reemit
