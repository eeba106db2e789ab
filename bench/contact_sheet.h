#pragma once
#include <filesystem>
#include <string>

#include <OpenImageIO/imagebuf.h>

#include "viewer_export/output/tone_map.h"
#include "viewer_export/still/still_image.h"

namespace reemit::bench {

/// Tone map of a picture as `reemit render` chooses it for PNG.
ToneMap tone_map_of(const StillImage& image);

/// Labelled pictures on a white sheet. All members throw std::runtime_error when OpenImageIO fails.
class ContactSheet {
 public:
  ContactSheet(int width, int height, std::string font = "DejaVuSans");  // [px]

  /// Text with its base line at (x, y).
  void label(int x, int y, const std::string& text);
  /// A picture with its upper left corner at (x, y), encoded sRGB.
  void paste(int x, int y, const StillImage& image, const ToneMap& tone_map);
  /// JPEG or PNG, by the extension.
  void write(const std::filesystem::path& file);

 private:
  std::string font_;
  OIIO::ImageBuf sheet_;
};

}  // namespace reemit::bench
