#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "tests/support/temp_folder.h"

namespace reemit::test {

/// A binary portable pixmap of 8-bit colours, row by row from the top.
inline void write_pixmap(const std::filesystem::path& file, int width, int height,
                         const std::vector<std::array<int, 3>>& pixels) {
  std::string bytes = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (const auto& pixel : pixels)
    for (const int channel : pixel) bytes += static_cast<char>(channel);
  write_bytes(file, bytes);
}

/// Any number of 8-bit channels, in the format of the extension; `tile` > 0: in tiles of so many pixels to a
/// side, where the format has them.
inline void write_png(const std::filesystem::path& file, int width, int height, int channels,
                      const std::vector<unsigned char>& values, int tile = 0) {
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.tile_width = spec.tile_height = tile;
  out->open(file.string(), spec);
  out->write_image(OIIO::TypeDesc::UINT8, values.data());
  out->close();
}

}  // namespace reemit::test
