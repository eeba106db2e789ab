#include "viewer_export/still/png_writer.h"

#include <string>

#include "solver/sampling/counter_rng.h"
#include "viewer_export/still/picture_metadata.h"
#include "viewer_export/still/png_encoding.h"

namespace reemit {

void write_png(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file) {
  const std::string statement = tone_map.statement();
  PngPicture picture{image.width, image.height, {}, {{"Description", statement}}};
  for (const auto& [name, value] : metadata_of(image)) picture.texts.emplace_back(name, value);
  picture.texts.emplace_back("reemit:tone_map", statement);

  const CounterRng dither(0, RngPurpose::kDither);
  picture.rgb.reserve(rgb.size());
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const Eigen::Array3d shown = tone_map({rgb[3 * pixel], rgb[3 * pixel + 1], rgb[3 * pixel + 2]});
    const auto noise = dither.uniform4(pixel, 0, 0);
    for (std::size_t c = 0; c < 3; ++c)
      picture.rgb.push_back(srgb_byte(shown[static_cast<Eigen::Index>(c)], static_cast<double>(noise[c])));
  }
  encode_png(picture, file);
}

}  // namespace reemit
