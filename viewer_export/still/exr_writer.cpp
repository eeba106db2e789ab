#include "viewer_export/still/exr_writer.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "viewer_export/still/image_encoding.h"

namespace reemit {
namespace {

constexpr float kWhiteLuminance = 179;  // [cd/m2] of R = G = B = 1 W/(m2 sr)

// One channel of the file: values[pixel * stride + offset] of a layer.
struct Channel {
  std::string name;
  const float* values;
  std::size_t stride;
  std::size_t offset;
};

// As EXR viewers expect them: colour in R G B, a single value in Y, else the wavelength.
std::string channel_name(const BandSet& bands, std::size_t band) {
  switch (bands.kind()) {
    case BandKind::kGrey:
      return "Y";
    case BandKind::kRgb:
      return std::string(1, "RGB"[band]);
    case BandKind::kSpectral:
      break;
  }
  return bands.name(band) + "nm";
}

std::vector<Channel> channels_of(const StillImage& image, std::span<const float> rgb) {
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), rgb.data(), 3, c});
  const std::size_t bands = image.bands.count();
  const auto add_bands = [&](const std::string& layer, const std::vector<float>& values) {
    if (values.empty()) return;
    for (std::size_t band = 0; band < bands; ++band)
      channels.push_back({layer + "." + channel_name(image.bands, band), values.data(), bands, band});
  };
  if (image.bands.kind() != BandKind::kRgb) add_bands("radiance", image.radiance);
  add_bands("direct", image.direct);
  add_bands("indirect", image.indirect);
  add_bands("caustic", image.caustic);
  add_bands("stderr", image.radiance_stderr);
  add_bands("albedo", image.albedo);
  if (!image.samples.empty()) channels.push_back({"samples.Y", image.samples.data(), 1, 0});
  if (!image.depth.empty()) channels.push_back({"depth.Z", image.depth.data(), 1, 0});
  if (!image.normal.empty())
    for (std::size_t c = 0; c < 3; ++c)
      channels.push_back({"normal." + std::string(1, "XYZ"[c]), image.normal.data(), 3, c});
  return channels;
}

}  // namespace

void write_exr(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file) {
  const std::vector<Channel> channels = channels_of(image, rgb);
  std::vector<std::string> names(channels.size());
  std::transform(channels.begin(), channels.end(), names.begin(), [](const Channel& c) { return c.name; });
  ImageDescription description = sized_as(image, "openexr", PixelType::kFloat, std::move(names));
  const std::vector<float> rec709 = {0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
  description.attributes = {{"chromaticities", rec709},
                            {"whiteLuminance", kWhiteLuminance},
                            {"compression", image.interrupted ? "none" : "zip"},
                            {"oiio:ColorSpace", "Linear"}};
  add_metadata(image, description);
  description.attributes.emplace_back("reemit:suggested_display", tone_map.statement());

  std::vector<float> pixels(image.pixel_count() * channels.size());
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
    for (std::size_t c = 0; c < channels.size(); ++c)
      pixels[pixel * channels.size() + c] =
          channels[c].values[pixel * channels[c].stride + channels[c].offset];
  encode_image(description, pixels.data(), file);
}

}  // namespace reemit
