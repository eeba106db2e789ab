#include "bench/contact_sheet.h"

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include <OpenImageIO/imagebufalgo.h>

namespace reemit::bench {
namespace {

void require(bool done, const OIIO::ImageBuf& image) {
  if (!done) throw std::runtime_error(image.geterror());
}

}  // namespace

ToneMap tone_map_of(const StillImage& image) {
  return make_tone_map(rgb_of(image));
}

ContactSheet::ContactSheet(int width, int height, std::string font)
    : font_(std::move(font)), sheet_(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8)) {
  constexpr float kWhite[3] = {1, 1, 1};
  require(OIIO::ImageBufAlgo::fill(sheet_, kWhite), sheet_);
}

void ContactSheet::label(int x, int y, const std::string& text) {
  constexpr int kSize = 12;
  constexpr float kBlack[3] = {0, 0, 0};
  require(OIIO::ImageBufAlgo::render_text(sheet_, x, y, text, kSize, font_, kBlack), sheet_);
}

void ContactSheet::paste(int x, int y, const StillImage& image, const ToneMap& tone_map) {
  const std::vector<float> rgb = rgb_of(image);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    for (const double c : tone_map({rgb[i], rgb[i + 1], rgb[i + 2]})) bytes.push_back(srgb_byte(c));
  const OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  OIIO::ImageBuf buffer(spec);
  require(buffer.set_pixels(OIIO::get_roi(spec), OIIO::TypeDesc::UINT8, bytes.data()), buffer);
  require(OIIO::ImageBufAlgo::paste(sheet_, x, y, 0, 0, buffer), sheet_);
}

void ContactSheet::write(const std::filesystem::path& file) {
  sheet_.specmod().attribute("Compression", "jpeg:88");
  require(sheet_.write(file.string()), sheet_);
}

}  // namespace reemit::bench
