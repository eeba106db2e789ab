#include "viewer_export/still/hdr_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/images/image_library.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

// The lines that OpenImageIO leaves out. They belong between the format line and the empty line that ends the
// header.
std::string extra_header(const StillImage& image, const ToneMap& tone_map) {
  std::string lines = "PRIMARIES=0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290\n";
  lines += fmt::format("SOFTWARE=reemit {}\n", one_line(image.info.program_version));
  for (const auto& [name, value] : describe(image.info, image.bands))
    lines += fmt::format("# {}: {}\n", name, value);
  lines += fmt::format("# suggested display: {}\n", tone_map.statement());
  return lines;
}

// What a shared-exponent pixel can hold: finite, not negative, and three times eight bits. The encoder cuts
// what is beyond the eight bits, which would make pictures 0.3 % darker, so they are rounded to here.
std::vector<float> representable(std::span<const float> rgb) {
  constexpr float kLargest = 1e38F;
  constexpr int kMantissaBits = 8;
  std::vector<float> result(rgb.begin(), rgb.end());
  for (float& value : result) value = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, kLargest);
  for (std::size_t pixel = 0; pixel + 2 < result.size(); pixel += 3) {
    const float largest = std::max({result[pixel], result[pixel + 1], result[pixel + 2]});
    if (largest == 0) continue;
    int exponent = 0;
    // Rounding may carry the largest beyond the eight bits of its exponent; the next one then serves all.
    if (std::frexp(largest, &exponent) >= 1 - std::ldexp(1.0F, -kMantissaBits - 1)) ++exponent;
    for (std::size_t c = pixel; c < pixel + 3; ++c)
      result[c] = std::ldexp(std::nearbyint(std::ldexp(result[c], kMantissaBits - exponent)),
                             exponent - kMantissaBits);
  }
  return result;
}

// The encoder writes into memory, for lines to be added to the header.
class MemorySink final : public ByteSink {
 public:
  void write_at(std::uint64_t offset, const void* from, std::size_t size) override {
    bytes.resize(std::max(bytes.size(), offset + size));
    std::memcpy(bytes.data() + offset, from, size);
  }
  std::string bytes;
};

}  // namespace

void write_hdr(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file) {
  const std::vector<float> pixels = representable(rgb);
  const ImageDescription description{"hdr", image.width, image.height, {"R", "G", "B"}, PixelType::kFloat};
  MemorySink encoded;
  if (const std::string error = image_library().encode(description, pixels.data(), encoded); !error.empty())
    throw ResourceError("hdr image", "OpenImageIO cannot write it: " + error,
                        "Check that OpenImageIO was built with this format.");
  const std::string_view bytes = encoded.bytes;
  const std::size_t header_end = bytes.find("\n\n");
  if (header_end == std::string_view::npos ||
      bytes.substr(0, header_end).find("PRIMARIES=") != std::string_view::npos)
    throw ResourceError("hdr image", "OpenImageIO wrote a header of an unknown form", "Write .exr instead.");
  file.write(bytes.substr(0, header_end + 1));
  file.write(extra_header(image, tone_map));
  file.write(bytes.substr(header_end + 1));
}

}  // namespace reemit
