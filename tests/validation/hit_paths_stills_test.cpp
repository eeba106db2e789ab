// Picture files that are compared with the reference.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "bench/hit_paths/checked_picture.h"
#include "tests/support/temp_folder.h"
#include "viewer_export/still/image_file.h"

namespace reemit::hit_paths {
namespace {

/// Of two blocks and a rest; in band b of every pixel radiance `base` + b, in the second block twice that.
StillImage two_blocks(const BandSet& bands, float base) {
  StillImage image;
  image.bands = bands;
  image.width = 2 * kBlock;
  image.height = kBlock + 3;
  for (std::size_t p = 0; p < image.pixel_count(); ++p)
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const bool second = p % (2 * kBlock) >= kBlock;
      image.radiance.push_back((second ? 2.0F : 1.0F) * (base + static_cast<float>(b)));
      image.radiance_stderr.push_back(0.16F);
    }
  return image;
}

TEST(CheckedPicture, of_files_has_the_means_and_errors_of_their_blocks) {
  for (const BandSet& bands : {BandSet::grey(), BandSet::rgb()}) {
    const test::TempFolder folder;
    write_still_image(two_blocks(bands, 1), folder / "a.exr");
    write_still_image(two_blocks(bands, 1.5), folder / "b.exr");
    const CheckedPicture one = read_checked({folder / "a.exr"}, bands);
    ASSERT_EQ(one.blocks.size(), 2 * bands.count());
    const CheckedPicture both = read_checked({folder / "a.exr", folder / "b.exr"}, bands);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      EXPECT_NEAR(one.blocks[b].mean(), 1.0 + static_cast<double>(b), 1e-6);
      EXPECT_NEAR(one.blocks[bands.count() + b].mean(), 2 * (1.0 + static_cast<double>(b)), 1e-6);
      EXPECT_NEAR(one.blocks[b].standard_error(), 0.16 / kBlock, 1e-6) << "256 pixels that are independent";
      EXPECT_NEAR(both.blocks[b].mean(), 1.25 + static_cast<double>(b), 1e-6);
      EXPECT_NEAR(both.blocks[b].standard_error(), 0.25, 1e-6) << "their spread";
    }
  }
}

TEST(CheckedPicture, refuses_other_bands_and_sizes) {
  const test::TempFolder folder;
  const BandSet grey = BandSet::grey();
  write_still_image(two_blocks(grey, 1), folder / "grey.exr");
  EXPECT_THROW(read_checked({folder / "grey.exr"}, BandSet::spectral({500, 600})), std::invalid_argument);
  StillImage small = two_blocks(grey, 1);
  small.height -= 1;
  small.radiance.resize(small.pixel_count());
  small.radiance_stderr.resize(small.pixel_count());
  write_still_image(small, folder / "small.exr");
  EXPECT_THROW(read_checked({folder / "grey.exr", folder / "small.exr"}, grey), std::invalid_argument);
}

}  // namespace
}  // namespace reemit::hit_paths
