#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace reemit::test
