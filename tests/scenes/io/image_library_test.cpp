#include "scenes/io/images/image_library.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/encoded_image.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr int kWidth = 3, kHeight = 2;

ImageDescription grey(const std::string& format) {
  return {format, kWidth, kHeight, {"Y"}, PixelType::kByte};
}

const Bytes& pixels() {
  static const Bytes values = {0, 20, 40, 60, 80, 255};
  return values;
}

class FullDisk final : public ByteSink {
 public:
  void write_at(std::uint64_t, const void*, std::size_t) override { throw std::length_error("no room"); }
};

Bytes encoded() {
  const std::string bytes = test::encoded_image(grey("png"), pixels().data());
  return {bytes.begin(), bytes.end()};
}

void expect_pixels(const OpenedImage& opened) {
  ASSERT_TRUE(opened.reader) << opened.problem;
  const ImageLayout layout = opened.reader->layout();
  EXPECT_EQ(layout.width, kWidth);
  EXPECT_EQ(layout.height, kHeight);
  EXPECT_EQ(layout.channels, 1);
  EXPECT_FALSE(layout.is_float);
  EXPECT_EQ(layout.rows_together, 1);
  Bytes row(kWidth);
  for (int y = 0; y < kHeight; ++y) {
    ASSERT_TRUE(opened.reader->read_rows(y, y + 1, PixelType::kByte, row.data()));
    EXPECT_EQ(row, Bytes(pixels().begin() + y * kWidth, pixels().begin() + (y + 1) * kWidth));
  }
}

TEST(ImageLibrary, ReadsFromMemoryWhatItWrote) {
  const Bytes bytes = encoded();
  expect_pixels(image_library().open("any.png", bytes.data(), bytes.size()));
}

TEST(ImageLibrary, ReadsAFileWhateverElseIsOpen) {
  const test::TempFolder folder;
  const Bytes bytes = encoded();
  const std::string file = (folder / "a.png").string();
  test::write_bytes(file, std::string(bytes.begin(), bytes.end()));
  const OpenedImage first = image_library().open(file);
  expect_pixels(image_library().open(file));
  expect_pixels(first);
}

TEST(ImageLibrary, GivesBytesAsSharesOf255WhereFloatsAreAskedFor) {
  const Bytes bytes = encoded();
  const OpenedImage opened = image_library().open("any.png", bytes.data(), bytes.size());
  ASSERT_TRUE(opened.reader) << opened.problem;
  std::array<float, kWidth * kHeight> values{};
  for (int row = 0; row < kHeight; ++row)
    ASSERT_TRUE(opened.reader->read_rows(row, row + 1, PixelType::kFloat, &values[row * kWidth]));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_FLOAT_EQ(values[i], static_cast<float>(pixels()[i]) / 255.0F) << i;
}

TEST(ImageLibrary, SaysWhyThereIsNoImage) {
  const Bytes text = {'t', 'e', 'x', 't'};
  const std::string no_format = "any.nothing";
  for (const OpenedImage& opened :
       {image_library().open("/nowhere/a.png"), image_library().open("any.png", text.data(), text.size()),
        image_library().open(no_format, text.data(), text.size())}) {
    EXPECT_FALSE(opened.reader);
    EXPECT_NE(opened.problem, "");
  }
  test::ImageBytes memory;
  EXPECT_NE(image_library().encode(grey("nothing"), pixels().data(), memory), "");
  EXPECT_TRUE(memory.bytes.empty());
}

// The encoder is C code in between.
TEST(ImageLibrary, PassesOnWhatTheSinkThrows) {
  FullDisk disk;
  EXPECT_THROW(image_library().encode(grey("png"), pixels().data(), disk), std::length_error);
}

}  // namespace
}  // namespace reemit
