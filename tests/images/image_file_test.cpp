#include "viewer_export/still/image_file.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <sstream>

#include <Eigen/LU>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "solver/sampling/counter_rng.h"
#include "tests/support/small_disk.h"
#include "tests/support/temp_folder.h"
#include "viewer_export/still/png_encoding.h"

namespace reemit {
namespace {

using test::read_bytes;
using test::TempFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

// All layers, a different number in every value.
StillImage sample_image(const BandSet& bands, int width = 5, int height = 3) {
  StillImage image;
  image.info.program_version = "1.2.3";
  image.info.room = "kitchen.json";
  image.info.seed = 77;
  image.info.settings = {{"samples per pixel", std::uint64_t{64}}};
  image.bands = bands;
  image.width = width;
  image.height = height;
  float next = 0;
  const auto fill = [&](std::vector<float>& layer, std::size_t channels, float scale) {
    for (std::size_t i = 0; i < image.pixel_count() * channels; ++i) layer.push_back(scale * (next += 1));
  };
  const std::size_t count = bands.count();
  fill(image.radiance, count, 0.01F);
  fill(image.direct, count, 0.007F);
  fill(image.indirect, count, 0.003F);
  if (bands.kind() == BandKind::kRgb) fill(image.caustic, count, 0.002F);
  fill(image.radiance_stderr, count, 1e-4F);
  fill(image.albedo, count, 1e-3F);
  fill(image.samples, 1, 1);
  fill(image.depth, 1, 0.5F);
  image.depth.back() = std::numeric_limits<float>::infinity();
  fill(image.normal, 3, 1e-3F);
  return image;
}

struct ReadImage {
  OIIO::ImageSpec spec;
  std::vector<float> pixels;

  float at(std::size_t pixel, const std::string& channel) const {
    const int c = spec.channelindex(channel);
    if (c < 0) {
      ADD_FAILURE() << "no channel " << channel;
      return 0;
    }
    return pixels[pixel * static_cast<std::size_t>(spec.nchannels) + static_cast<std::size_t>(c)];
  }
};

ReadImage read_image(const std::filesystem::path& file) {
  const auto input = OIIO::ImageInput::open(file.string());
  if (!input) {
    ADD_FAILURE() << OIIO::geterror();
    return {};
  }
  ReadImage image{input->spec(), {}};
  image.pixels.resize(image.spec.image_pixels() * static_cast<std::size_t>(image.spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, image.pixels.data()));
  return image;
}

TEST(ExrWriter, HoldsAllLayersExactly) {
  const TempFolder folder;
  const StillImage image = sample_image(BandSet::rgb());
  EXPECT_FALSE(write_still_image(image, folder / "a.exr").tone_mapped);
  const ReadImage read = read_image(folder / "a.exr");
  ASSERT_EQ(read.spec.width, 5);
  ASSERT_EQ(read.spec.height, 3);
  EXPECT_EQ(read.spec.nchannels, 3 + 5 * 3 + 1 + 1 + 3);
  EXPECT_EQ(read.spec.format, OIIO::TypeDesc::FLOAT);
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::string name(1, "RGB"[c]);
      EXPECT_EQ(read.at(pixel, name), image.radiance[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, "direct." + name), image.direct[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, "indirect." + name), image.indirect[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, "caustic." + name), image.caustic[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, "stderr." + name), image.radiance_stderr[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, "albedo." + name), image.albedo[3 * pixel + c]);
      EXPECT_EQ(read.at(pixel, std::string("normal.") + "XYZ"[c]), image.normal[3 * pixel + c]);
    }
    EXPECT_EQ(read.at(pixel, "samples.Y"), image.samples[pixel]);
    EXPECT_EQ(read.at(pixel, "depth.Z"), image.depth[pixel]);
  }
}

TEST(ExrWriter, StatesColourSpaceAndSettings) {
  const TempFolder folder;
  write_still_image(sample_image(BandSet::rgb()), folder / "a.exr");
  const OIIO::ImageSpec spec = read_image(folder / "a.exr").spec;
  EXPECT_EQ(spec.get_float_attribute("whiteLuminance"), 179);
  const auto* chromaticities =
      spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  ASSERT_NE(chromaticities, nullptr);
  EXPECT_FLOAT_EQ(static_cast<const float*>(chromaticities->data())[7], 0.329F);
  EXPECT_EQ(spec.get_string_attribute("reemit:seed"), "77");
  EXPECT_EQ(spec.get_string_attribute("reemit:samples_per_pixel"), "64");
  EXPECT_THAT(std::string(spec.get_string_attribute("reemit:units")), HasSubstr("W/(m2 sr)"));
}

TEST(ExrWriter, KeepsSpectralBandsBesideRgb) {
  const TempFolder folder;
  const StillImage image = sample_image(BandSet::spectral({450, 550, 650, 700}));
  write_still_image(image, folder / "a.exr");
  const ReadImage read = read_image(folder / "a.exr");
  Spectrum value(4);
  for (int b = 0; b < 4; ++b) value[b] = image.radiance[4 * 6 + static_cast<std::size_t>(b)];
  EXPECT_FLOAT_EQ(read.at(6, "G"), static_cast<float>(image.bands.to_rgb(value)[1]));
  EXPECT_EQ(read.at(6, "radiance.550nm"), image.radiance[4 * 6 + 1]);
  EXPECT_EQ(read.at(6, "stderr.700nm"), image.radiance_stderr[4 * 6 + 3]);
}

TEST(ExrWriter, LeavesOutLayersThatWereNotComputed) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::grey());
  image.direct.clear();
  image.indirect.clear();
  image.radiance_stderr.clear();
  image.albedo.clear();
  image.normal.clear();
  write_still_image(image, folder / "a.exr");
  const ReadImage read = read_image(folder / "a.exr");
  EXPECT_EQ(read.spec.nchannels, 3 + 1 + 1 + 1);
  EXPECT_EQ(read.at(4, "radiance.Y"), image.radiance[4]);
  EXPECT_FLOAT_EQ(read.at(4, "B"), image.radiance[4]);
}

// Reads a Radiance picture by its published layout, without OpenImageIO.
struct RadiancePicture {
  std::vector<std::string> header;
  std::string resolution;
  std::string data;
};

RadiancePicture parse_radiance(const std::string& bytes) {
  RadiancePicture picture;
  std::istringstream in(bytes);
  for (std::string line; std::getline(in, line) && !line.empty();) picture.header.push_back(line);
  std::getline(in, picture.resolution);
  picture.data.assign(std::istreambuf_iterator<char>(in), {});
  return picture;
}

TEST(HdrWriter, StatesItsPrimariesInTheHeader) {
  const TempFolder folder;
  EXPECT_FALSE(write_still_image(sample_image(BandSet::rgb()), folder / "a.hdr").tone_mapped);
  const RadiancePicture picture = parse_radiance(read_bytes(folder / "a.hdr"));
  ASSERT_FALSE(picture.header.empty());
  EXPECT_EQ(picture.header.front(), "#?RADIANCE");
  EXPECT_THAT(picture.header, testing::Contains("FORMAT=32-bit_rle_rgbe"));
  EXPECT_THAT(picture.header,
              testing::Contains("PRIMARIES=0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290"));
  EXPECT_THAT(picture.header, testing::Contains("# seed: 77"));
  EXPECT_EQ(picture.resolution, "-Y 3 +X 5");
}

TEST(HdrWriter, LuminanceComesOutRightWithTheStatedPrimaries) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::rgb(), 1, 1);
  image.radiance = {0.8F, 0.1F, 0.05F};  // red: where wrong primaries cost most
  write_still_image(image, folder / "a.hdr");
  const RadiancePicture picture = parse_radiance(read_bytes(folder / "a.hdr"));
  // A scanline this short is stored as plain RGBE: value = mantissa 2^(exponent - 136).
  ASSERT_EQ(picture.data.size(), 4U);
  const auto byte = [&](std::size_t i) {
    return static_cast<double>(static_cast<unsigned char>(picture.data[i]));
  };
  const double scale = std::exp2(byte(3) - 136);

  // Y weights of the primaries in the header: columns X Y Z of each primary, scaled so that white has Y = 1.
  double c[8] = {};
  for (const std::string& line : picture.header)
    std::sscanf(line.c_str(), "PRIMARIES=%lf %lf %lf %lf %lf %lf %lf %lf", &c[0], &c[1], &c[2], &c[3], &c[4],
                &c[5], &c[6], &c[7]);
  Eigen::Matrix3d primaries;
  for (int i = 0; i < 3; ++i) primaries.col(i) << c[2 * i], c[2 * i + 1], 1 - c[2 * i] - c[2 * i + 1];
  const Eigen::Vector3d white = Eigen::Vector3d(c[6], c[7], 1 - c[6] - c[7]) / c[7];
  const Eigen::Vector3d amounts = primaries.inverse() * white;
  double y = 0;
  for (int i = 0; i < 3; ++i) y += amounts[i] * primaries(1, i) * byte(static_cast<std::size_t>(i)) * scale;
  const double expected = luminance({0.8, 0.1, 0.05});
  EXPECT_NEAR(y / expected, 1, 0.01);  // 8-bit mantissas
}

TEST(HdrWriter, RoundsToTheNearestMantissa) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::rgb(), 40, 20);
  for (std::size_t i = 0; i < image.radiance.size();
       ++i)  // three decades, the last a carry to the next power of two
    image.radiance[i] = std::pow(10.0F, 3 * static_cast<float>(i) / 2399 - 1.5F);
  image.radiance[0] = image.radiance[1] = image.radiance[2] = 0.9995F;
  write_still_image(image, folder / "a.hdr");
  const ReadImage read = read_image(folder / "a.hdr");
  EXPECT_EQ(read.pixels[0], 1);
  double sum = 0;
  for (std::size_t i = 3; i < read.pixels.size(); ++i) {
    const double ratio = static_cast<double>(read.pixels[i]) / static_cast<double>(image.radiance[i]);
    EXPECT_NEAR(ratio, 1, 1.01 / 256) << i;  // half a step of the smallest mantissa
    sum += ratio - 1;
  }
  // Cut instead, the mean would be -0.0034; of 2397 errors that are even within +-0.0039 it has an s of 4e-5.
  EXPECT_NEAR(sum / 2397, 0, 2e-4);
}

TEST(ExrWriter, WritesTheSameBytesOnAnyNumberOfThreads) {
  const TempFolder folder;
  const StillImage image = sample_image(BandSet::rgb(), 40, 100);  // blocks of 16 lines are compressed as one
  const auto written_by = [&](int threads) {
    tbb::task_arena arena(threads);
    arena.execute([&] { write_still_image(image, folder / "a.exr"); });
    return read_bytes(folder / "a.exr");
  };
  const std::string by_one = written_by(1);
  EXPECT_EQ(written_by(3), by_one);
  EXPECT_EQ(written_by(1), by_one);
}

TEST(ExrWriter, SaysNothingAboutWhenItWasWritten) {
  const TempFolder folder;
  write_still_image(sample_image(BandSet::rgb()), folder / "a.exr");
  EXPECT_EQ(read_image(folder / "a.exr").spec.get_string_attribute("DateTime"), "");
}

TEST(HdrWriter, IsReadBackByOpenImageIO) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::rgb(), 40, 20);  // long enough for run-length coding
  image.radiance[0] = std::numeric_limits<float>::quiet_NaN();
  image.radiance[1] = -3;
  write_still_image(image, folder / "a.hdr");
  const ReadImage read = read_image(folder / "a.hdr");
  ASSERT_EQ(read.pixels.size(), image.radiance.size());
  EXPECT_NEAR(read.pixels[0], 0, 1e-3);
  EXPECT_NEAR(read.pixels[1], 0, 1e-3);
  for (std::size_t i = 3; i < read.pixels.size(); ++i)
    EXPECT_NEAR(read.pixels[i], image.radiance[i], 0.01 * std::max(0.01F, image.radiance[i]));
}

TEST(PngWriter, IsToneMappedDitheredAndStatesItsExposure) {
  const TempFolder folder;
  const StillImage image = sample_image(BandSet::rgb(), 16, 9);
  const WrittenImage written = write_still_image(image, folder / "a.png");
  EXPECT_TRUE(written.tone_mapped);
  const ReadImage read = read_image(folder / "a.png");
  EXPECT_EQ(read.spec.format, OIIO::TypeDesc::UINT8);
  ASSERT_EQ(read.pixels.size(), image.radiance.size());
  std::size_t not_nearest = 0;
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    const float* rgb = image.radiance.data() + 3 * pixel;
    const Eigen::Array3d shown = written.tone_map(Eigen::Array3d(rgb[0], rgb[1], rgb[2]));
    for (std::size_t c = 0; c < 3; ++c) {
      const double exact = 255 * srgb_encoded(shown[static_cast<Eigen::Index>(c)]);
      const double stored = 255 * static_cast<double>(read.pixels[3 * pixel + c]);
      EXPECT_LE(std::abs(stored - exact), 1.001);
      if (std::abs(stored - exact) > 0.51) ++not_nearest;
    }
  }
  EXPECT_GT(not_nearest, image.pixel_count() / 4);  // rounding to nearest would have none
  EXPECT_THAT(std::string(read.spec.get_string_attribute("ImageDescription")),
              HasSubstr(written.tone_map.statement()));
  EXPECT_EQ(read.spec.get_string_attribute("reemit:seed"), "77");
}

TEST(PngWriter, BlackIsExactlyBlackAndBytesRepeat) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::grey(), 20, 20);
  std::fill(image.radiance.begin(), image.radiance.end(), 0.0F);
  write_still_image(image, folder / "black.png");
  for (const float value : read_image(folder / "black.png").pixels) EXPECT_EQ(value, 0);
  const StillImage other = sample_image(BandSet::grey(), 20, 20);
  write_still_image(other, folder / "a.png");
  write_still_image(other, folder / "b.png");
  EXPECT_EQ(read_bytes(folder / "a.png"), read_bytes(folder / "b.png"));
}

TEST(PngWriter, MetadataKeepLettersOfAllAlphabets) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::rgb());
  image.info.room = "B\u00fcro/\u90e8\u5c4b.json";
  write_still_image(image, folder / "a.png");
  const std::string bytes = read_bytes(folder / "a.png");
  // Of a chunk for UTF-8: keyword, not compressed, no language, keyword not translated, text.
  const std::string chunk = "iTXtreemit:room" + std::string(5, '\0') + image.info.room;
  EXPECT_NE(bytes.find(chunk), std::string::npos);
  EXPECT_NE(bytes.find("tEXtSoftware" + std::string(1, '\0') + "reemit 1.2.3"), std::string::npos);
}

TEST(PngWriter, WhatTheEncoderCannotDoIsAnError) {
  const TempFolder folder;
  // More columns than libpng takes.
  const PngPicture wide{2'000'000, 1, std::vector<std::uint8_t>(6'000'000), {}};
  const auto write = [&](const PngPicture& picture) {
    OutputFile file(folder / "a.png");
    encode_png(picture, file);
    file.commit();
  };
  EXPECT_THAT([&] { write(wide); }, ThrowsMessage<ResourceError>(HasSubstr("libpng cannot write it: ")));
  // Bytes that do not compress, so that the disk is full while it encodes.
  constexpr int kSize = 512;
  PngPicture noise{kSize, kSize, {}, {}};
  const CounterRng random(5, RngPurpose::kDither);
  for (std::uint32_t i = 0; i < 3 * kSize * kSize; ++i)
    noise.rgb.push_back(static_cast<std::uint8_t>(random.bits4(i, 0, 0)[0]));
  const test::SmallDisk disk(100);
  EXPECT_THROW(write(noise), ResourceError);
  EXPECT_TRUE(folder.listing().empty());
}

TEST(ImageFile, FixedExposureIsUsed) {
  const TempFolder folder;
  ToneMapSettings settings;
  settings.exposure_ev = 4;
  const WrittenImage written = write_still_image(sample_image(BandSet::rgb()), folder / "a.png", settings);
  EXPECT_EQ(written.tone_map.exposure(), 16);
}

TEST(ImageFile, RefusesUnknownExtensionsAndBadImages) {
  const TempFolder folder;
  StillImage image = sample_image(BandSet::rgb());
  EXPECT_THAT([&] { write_still_image(image, folder / "a.jpg"); },
              ThrowsMessage<InputError>(HasSubstr(".exr, .hdr, .png")));
  image.depth.pop_back();
  EXPECT_THROW(write_still_image(image, folder / "a.exr"), std::invalid_argument);
  image = sample_image(BandSet::rgb());
  image.width = 0;
  EXPECT_THROW(write_still_image(image, folder / "a.exr"), std::invalid_argument);
  EXPECT_TRUE(folder.listing().empty());
}

TEST(ImageFile, FullDiskKeepsThePreviousPicture) {
  const TempFolder folder;
  const StillImage image = sample_image(BandSet::rgb(), 64, 64);
  for (const ImageFormat& format : image_formats()) {
    const auto file = folder / ("a" + std::string(format.extension));
    write_still_image(image, file);
    const std::string before = read_bytes(file);
    for (const std::size_t limit : {std::size_t{0}, std::size_t{100}, before.size() / 2, before.size() - 1}) {
      const test::SmallDisk disk(limit);
      EXPECT_THROW(write_still_image(image, file), ResourceError) << format.extension << " " << limit;
    }
    EXPECT_EQ(read_bytes(file), before) << format.extension;
  }
  EXPECT_EQ(folder.listing().size(), image_formats().size());
}

}  // namespace
}  // namespace reemit
