#include "viewer_export/output/tone_map.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Grey pixels whose luminances are 2^low ... 2^high, evenly spread in stops.
std::vector<float> grey_ramp(int low, int high) {
  std::vector<float> rgb;
  for (int stop = low; stop <= high; ++stop) rgb.insert(rgb.end(), 3, std::exp2f(static_cast<float>(stop)));
  return rgb;
}

TEST(ToneMap, IsMonotoneFromBlackToWhite) {
  for (const double white : {0.3, 1.0, 8.0, 1e4}) {
    const ToneMap map(1, white);
    EXPECT_EQ(map.display_luminance(0), 0);
    EXPECT_DOUBLE_EQ(map.display_luminance(white), 1);
    EXPECT_EQ(map.display_luminance(10 * white), 1);
    EXPECT_EQ(map.display_luminance(std::numeric_limits<double>::infinity()), 1);
    double previous = 0;
    for (double y = white * 1e-6; y < white; y *= 1.01) {
      const double shown = map.display_luminance(y);
      EXPECT_GT(shown, previous) << white << " " << y;
      EXPECT_LE(shown, 1);
      previous = shown;
    }
  }
}

TEST(ToneMap, ShowsTheLogAverageAsTheKey) {
  for (const double key : {0.1, 0.18, 0.36})
    for (const std::optional<double> white : {std::optional<double>(), std::optional<double>(3.0)}) {
      ToneMapSettings settings;
      settings.key = key;
      settings.white = white;
      const ToneMap map = make_tone_map(grey_ramp(-13, 3), settings);  // log-average 2^-5
      EXPECT_NEAR(map.display_luminance(map.exposure() * std::exp2(-5)), key, 1e-12);
      const Eigen::Array3d shown = map(Eigen::Array3d::Constant(std::exp2(-5)));
      EXPECT_NEAR(shown[0], key, 1e-9);
    }
}

TEST(ToneMap, AutomaticExposureFollowsTheScaleOfThePicture) {
  std::vector<float> rgb = grey_ramp(-6, 2);
  const ToneMap map = make_tone_map(rgb);
  for (float& value : rgb) value *= 1024;
  const ToneMap brighter = make_tone_map(rgb);
  EXPECT_NEAR(brighter.exposure() * 1024 / map.exposure(), 1, 1e-6);
  EXPECT_NEAR(brighter.white() / map.white(), 1, 1e-6);
}

TEST(ToneMap, BlackAndBrokenPixelsDoNotDecideOverExposure) {
  std::vector<float> rgb = grey_ramp(-6, 2);
  const ToneMap map = make_tone_map(rgb);
  rgb.insert(rgb.end(), {0, 0, 0, kNaN, 1, 1, kInfinity, kInfinity, kInfinity, -1, -1, -1});
  const ToneMap same = make_tone_map(rgb);
  EXPECT_EQ(same.exposure(), map.exposure());
  EXPECT_EQ(same.white(), map.white());
}

TEST(ToneMap, UniformAndBlackPicturesWork) {
  const ToneMap uniform = make_tone_map(std::vector<float>(30, 7.0F));
  EXPECT_NEAR(uniform(Eigen::Array3d::Constant(7))[1], 0.18, 1e-6);
  const ToneMap black = make_tone_map(std::vector<float>(30, 0.0F));
  EXPECT_EQ(black.exposure(), 1);
  EXPECT_TRUE((black(Eigen::Array3d::Zero()) == 0).all());
  EXPECT_EQ(make_tone_map({}).exposure(), 1);
}

TEST(ToneMap, FixedExposureDoesNotDependOnThePicture) {
  ToneMapSettings settings;
  settings.exposure_ev = -3;
  const ToneMap dim = make_tone_map(grey_ramp(-6, 2), settings);
  const ToneMap bright = make_tone_map(grey_ramp(4, 12), settings);
  EXPECT_EQ(dim.exposure(), 0.125);
  EXPECT_EQ(dim.exposure_ev(), -3);
  EXPECT_EQ(bright.exposure(), dim.exposure());
  EXPECT_EQ(bright.white(), dim.white());
}

TEST(ToneMap, KeepsHueInsideTheGamut) {
  const ToneMap map(1, 100);
  const Eigen::Array3d colour(0.2, 0.1, 0.05);
  const Eigen::Array3d shown = map(colour);
  EXPECT_NEAR(shown[0] / shown[1], 2, 1e-12);
  EXPECT_NEAR(shown[1] / shown[2], 2, 1e-12);
  EXPECT_NEAR(luminance(shown), map.display_luminance(luminance(colour)), 1e-12);
}

TEST(ToneMap, SaturatedColoursStayDisplayableAtTheirLuminance) {
  const ToneMap map(1, 50);
  for (const Eigen::Array3d& colour :
       {Eigen::Array3d(0, 0, 80), Eigen::Array3d(60, 0.1, 0), Eigen::Array3d(3, -0.5, 1)}) {
    const Eigen::Array3d shown = map(colour);
    EXPECT_TRUE((shown >= 0).all() && (shown <= 1).all());
    EXPECT_NEAR(luminance(shown), map.display_luminance(luminance(colour)), 1e-9);
  }
}

TEST(ToneMap, BrokenColoursBecomeBlackOrWhite) {
  const ToneMap map(1, 8);
  EXPECT_TRUE((map({kNaN, 1, 1}) == 0).all());
  EXPECT_TRUE((map({-1, -1, -1}) == 0).all());
  EXPECT_TRUE((map({kInfinity, 1, 1}) == 1).all());
  EXPECT_TRUE((map({1e300, 1e300, 1e300}) == 1).all());
}

TEST(ToneMap, RefusesSettingsOutOfRange) {
  EXPECT_THROW(ToneMap(0, 1), std::invalid_argument);
  EXPECT_THROW(ToneMap(1, kInfinity), std::invalid_argument);
  const auto with = [](auto ToneMapSettings::*member, double value) {
    ToneMapSettings settings;
    settings.*member = value;
    return settings;
  };
  EXPECT_THROW(make_tone_map({}, with(&ToneMapSettings::exposure_ev, kNaN)), std::invalid_argument);
  EXPECT_THROW(make_tone_map({}, with(&ToneMapSettings::exposure_ev, 5000)), std::invalid_argument);
  EXPECT_THROW(make_tone_map({}, with(&ToneMapSettings::white, -1)), std::invalid_argument);
  EXPECT_THROW(make_tone_map({}, with(&ToneMapSettings::key, 0.9)), std::invalid_argument);
}

TEST(Srgb, EncodesKnownValues) {
  EXPECT_EQ(srgb_byte(0, 0.999), 0);
  EXPECT_EQ(srgb_byte(1, 0.999), 255);
  EXPECT_EQ(srgb_byte(1, 0), 255);
  EXPECT_EQ(srgb_byte(0.18), 118);
  EXPECT_EQ(srgb_byte(0.5), 188);
  EXPECT_EQ(srgb_byte(kNaN), 0);
  EXPECT_EQ(srgb_byte(7), 255);
}

TEST(Srgb, DitherKeepsTheMean) {
  const double linear = 0.2;
  double sum = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) sum += srgb_byte(linear, (i + 0.5) / kSteps);
  EXPECT_NEAR(sum / kSteps, 255 * srgb_encoded(linear), 1.0 / kSteps);
}

}  // namespace
}  // namespace reemit
