#include "viewer_export/still/image_file.h"

#include "viewer_export/output/file_extension.h"
#include "viewer_export/still/exr_writer.h"
#include "viewer_export/still/hdr_writer.h"
#include "viewer_export/still/png_writer.h"

namespace reemit {
namespace {

constexpr ImageFormat kImageFormats[] = {
    {".exr", "OpenEXR, 32-bit float radiance with all layers", false, false, write_exr},
    {".hdr", "Radiance picture, shared-exponent radiance", false, true, write_hdr},
    {".png", "8-bit sRGB, tone-mapped", true, false, write_png},
};

}  // namespace

std::span<const ImageFormat> image_formats() {
  return kImageFormats;
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
