#include "viewer_export/still/png_writer.h"

#include <vector>

#include "solver/sampling/counter_rng.h"
#include "viewer_export/still/image_encoding.h"

namespace reemit {

void write_png(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file) {
  ImageDescription description = sized_as(image, "png", PixelType::kByte);
  description.attributes = {{"oiio:ColorSpace", "sRGB"}, {"ImageDescription", tone_map.statement()}};
  add_metadata(image, description);
  description.attributes.emplace_back("reemit:tone_map", tone_map.statement());

  const CounterRng dither(0, RngPurpose::kDither);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(rgb.size());
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const Eigen::Array3d shown = tone_map({rgb[3 * pixel], rgb[3 * pixel + 1], rgb[3 * pixel + 2]});
    const auto noise = dither.uniform4(pixel, 0, 0);
    for (std::size_t c = 0; c < 3; ++c)
      bytes.push_back(srgb_byte(shown[static_cast<Eigen::Index>(c)], static_cast<double>(noise[c])));
  }
  encode_image(description, bytes.data(), file);
}

}  // namespace reemit
