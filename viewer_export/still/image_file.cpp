#include "viewer_export/still/image_file.h"

#include "viewer_export/formats/file_extension.h"
#include "viewer_export/still/exr_writer.h"
#include "viewer_export/still/hdr_writer.h"
#include "viewer_export/still/png_writer.h"

namespace reemit {
namespace {

constexpr ImageFormat kFormats[] = {
    {".exr", "OpenEXR, 32-bit float radiance with all layers", false, write_exr},
    {".hdr", "Radiance picture, shared-exponent radiance", false, write_hdr},
    {".png", "8-bit sRGB, tone-mapped", true, write_png},
};

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

}  // namespace

std::span<const ImageFormat> image_formats() {
  return kFormats;
}

const ImageFormat& image_format_of(const std::filesystem::path& file) {
  return format_by_extension(image_formats(), file);
}

WrittenImage write_still_image(const StillImage& image, const std::filesystem::path& file,
                               const ToneMapSettings& settings) {
  const ImageFormat& format = image_format_of(file);
  check_consistent(image);
  const std::vector<float> rgb = rgb_of(image);
  const ToneMap tone_map = make_tone_map(rgb, settings);
  OutputFile output(file);
  format.write(image, rgb, tone_map, output);
  output.commit();
  return {tone_map, format.tone_mapped};
}

}  // namespace reemit
