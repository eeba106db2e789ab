#include "scenes/model/upsampling.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "scenes/model/colour.h"

namespace reemit {
namespace {

using Rgb = Eigen::Array3d;

BandSet bands_from(double first, double step, int count) {
  std::vector<double> centres;
  for (int i = 0; i < count; ++i) centres.push_back(first + step * i);
  return BandSet::spectral(centres);
}

Spectrum flat(const BandSet& bands) {
  Spectrum widths(static_cast<Eigen::Index>(bands.count()));
  for (std::size_t i = 0; i < bands.count(); ++i)
    widths[static_cast<Eigen::Index>(i)] = bands.range_nm(i).width();
  return widths;
}

/// Colour of a reflectance in equal-energy white.
Rgb colour_of(const Spectrum& reflectance, const BandSet& bands) {
  return bands.to_rgb(reflectance * flat(bands)) / bands.to_rgb(flat(bands));
}

template <class Visit>
void for_colours(int steps, Visit&& visit) {
  for (int r = 0; r <= steps; ++r)
    for (int g = 0; g <= steps; ++g)
      for (int b = 0; b <= steps; ++b) visit(Rgb(r, g, b) / steps);
}

TEST(Upsampling, EveryColourComesBackExactly) {
  for (const BandSet& bands : {bands_from(400, 10, 31), bands_from(380, 5, 81), bands_from(400, 20, 16)}) {
    const Upsampling upsampling(bands);
    for_colours(7, [&](const Rgb& rgb) {
      const Upsampled up = upsampling.reflectance(rgb);
      ASSERT_GE(up.values.minCoeff(), 0);
      ASSERT_LE(up.values.maxCoeff(), 1);
      ASSERT_LT((colour_of(up.values, bands) - rgb).abs().maxCoeff(), 1e-10) << rgb.transpose();
      ASSERT_LT(up.deviation, 1e-9);
    });
  }
}

TEST(Upsampling, ReflectancesAreSmoothAndGreyStaysGrey) {
  const BandSet bands = bands_from(400, 10, 31);
  const Upsampling upsampling(bands);
  for (const double grey : {0.0, 0.18, 1.0})
    EXPECT_TRUE((upsampling.reflectance(Rgb::Constant(grey)).values == grey).all());
  // A quadratic turns once: so does the spectrum.
  for_colours(4, [&](const Rgb& rgb) {
    const Spectrum s = upsampling.reflectance(rgb).values;
    int turns = 0;
    for (Eigen::Index i = 2; i < s.size(); ++i)
      turns += (s[i] - s[i - 1]) * (s[i - 1] - s[i - 2]) < -1e-20 ? 1 : 0;
    EXPECT_LE(turns, 1) << rgb.transpose();
  });
}

TEST(Upsampling, NoReflectanceLeavesItsPart) {
  const BandSet bands = bands_from(400, 10, 31);
  const Spectrum s = Upsampling(bands).reflectance({0.3, 0.1, 0.05}, 0.31).values;
  EXPECT_LE(s.maxCoeff(), 0.31);
  EXPECT_LT((colour_of(s, bands) - Rgb(0.3, 0.1, 0.05)).abs().maxCoeff(), 1e-10);
}

TEST(Upsampling, EmissionKeepsColourAndLuminance) {
  for (const BandSet& bands : {bands_from(400, 10, 31), bands_from(380, 5, 81)}) {
    const Upsampling upsampling(bands);
    for_colours(4, [&](const Rgb& colour) {
      const Rgb rgb = 80 * colour;
      const Spectrum s = upsampling.emission(rgb).values;
      ASSERT_GE(s.minCoeff(), 0);
      ASSERT_LT((bands.to_rgb(s) - rgb).abs().maxCoeff(), 1e-8) << rgb.transpose();
      const double luminance = 179 * (rec709_luminance_weights() * rgb).sum();
      ASSERT_NEAR((bands.efficacy_lm_per_w() * s).sum(), luminance, 1e-8 * (1 + luminance));
    });
  }
}

TEST(Upsampling, ReflectancesAreThoseOfTheLightTheyAreSeenIn) {
  const BandSet bands = bands_from(400, 10, 31);
  const Rgb lamp(1, 0.64, 0.18);  // The yellow lamp of the Cornell box.
  const Upsampling upsampling(bands, lamp);
  const Spectrum light = upsampling.emission(lamp).values;
  for (const Rgb& rgb :
       {Rgb(0.7388, 0.7355, 0.7497), Rgb(0.0980, 0.3757, 0.0298), Rgb(0.4844, 0.0479, 0.0459)}) {
    const Rgb sent = bands.to_rgb(light * upsampling.reflectance(rgb).values);
    EXPECT_LT((sent / lamp - rgb).abs().maxCoeff(), 1e-10) << rgb.transpose();
  }
  // In white light the green is another one, which is why the light is asked for.
  const Spectrum green = upsampling.reflectance({0.0980, 0.3757, 0.0298}).values;
  EXPECT_GT((colour_of(green, bands) - Rgb(0.0980, 0.3757, 0.0298)).abs().maxCoeff(), 0.02);
}

TEST(Upsampling, BandsThatCoverAPartGetTheirPart) {
  // The 10 bands of 400 ... 500 nm of a spectrum that is solved over all of the visible range.
  const BandSet whole = bands_from(362.5, 5, 94), part = bands_from(402.5, 5, 20);
  const Rgb rgb(0.2, 0.5, 0.7);
  const Spectrum all = Upsampling(whole).reflectance(rgb).values;
  EXPECT_TRUE(Upsampling(part).reflectance(rgb).values.isApprox(all.segment(8, 20), 1e-9));
  const Spectrum emitted = Upsampling(whole).emission(rgb).values;
  EXPECT_TRUE(Upsampling(part).emission(rgb).values.isApprox(emitted.segment(8, 20), 1e-9));
}

TEST(Upsampling, TooFewBandsSayHowFarTheyMiss) {
  const BandSet bands = bands_from(450, 100, 3);
  const Upsampled green = Upsampling(bands).reflectance({0, 1, 0});
  EXPECT_GT(green.deviation, 0.05);
  EXPECT_NEAR(green.deviation, (colour_of(green.values, bands) - Rgb(0, 1, 0)).matrix().norm(), 1e-9);
}

TEST(Upsampling, OneBandGetsTheLuminance) {
  const BandSet bands = BandSet::spectral({550});
  const Spectrum s = Upsampling(bands).emission({3, 2, 1}).values;
  EXPECT_NEAR(s[0] * bands.efficacy_lm_per_w()[0], 179 * (rec709_luminance_weights() * Rgb(3, 2, 1)).sum(),
              1e-9);
  EXPECT_EQ(Upsampling(BandSet::spectral({1000})).emission({3, 2, 1}).values[0], 0);
}

}  // namespace
}  // namespace reemit
