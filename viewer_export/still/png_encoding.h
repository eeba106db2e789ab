#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenes/io/common/output_file.h"

namespace reemit {

/// A picture of 8-bit sRGB as a PNG file holds it.
struct PngPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< [(row from the top * width + column) * 3 + channel]
  /// Metadata: keyword (1 to 79 letters of ASCII) and UTF-8 text.
  std::vector<std::pair<std::string, std::string>> texts;
};

/// Encodes it by libpng, which is loaded in no time, where what else writes images (scenes/io/images) takes a
/// quarter of a second. Equal pictures give equal bytes. Throws ResourceError when the disk is full or the
/// library fails.
void encode_png(const PngPicture& picture, OutputFile& file);

}  // namespace reemit
