#include "bench/hit_paths/still_file.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace reemit::hit_paths {
namespace {

/// Channels of a layer by band; the picture of RGB rooms has no layer's name.
std::vector<std::string> channels_of(const std::string& layer, const BandSet& bands) {
  std::vector<std::string> names;
  const std::string prefix = layer.empty() ? "" : layer + ".";
  for (std::size_t b = 0; b < bands.count(); ++b) switch (bands.kind()) {
      case BandKind::kGrey:
        names.push_back(prefix + "Y");
        break;
      case BandKind::kRgb:
        names.push_back(prefix + "RGB"[b]);
        break;
      case BandKind::kSpectral:
        names.push_back(prefix + bands.name(b) + "nm");
        break;
    }
  return names;
}

}  // namespace

StillImage read_still(const std::filesystem::path& file, const BandSet& bands) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) throw std::invalid_argument(file.string() + " is no picture: " + OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  const auto count = static_cast<std::size_t>(spec.nchannels);
  StillImage image;
  image.bands = bands;
  image.width = spec.width;
  image.height = spec.height;
  std::vector<float> pixels(image.pixel_count() * count);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()))
    throw std::invalid_argument(file.string() + " cannot be read: " + input->geterror());
  const auto take = [&](const std::string& layer, std::vector<float>& values) {
    values.resize(image.pixel_count() * bands.count());
    const std::vector<std::string> names = channels_of(layer, bands);
    for (std::size_t b = 0; b < names.size(); ++b) {
      const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), names[b]);
      if (found == spec.channelnames.end())
        throw std::invalid_argument(file.string() + " has no channel " + names[b]);
      const auto channel = static_cast<std::size_t>(found - spec.channelnames.begin());
      for (std::size_t p = 0; p < image.pixel_count(); ++p)
        values[p * bands.count() + b] = pixels[p * count + channel];
    }
  };
  take(bands.kind() == BandKind::kRgb ? "" : "radiance", image.radiance);
  take("stderr", image.radiance_stderr);
  return image;
}

}  // namespace reemit::hit_paths
