#include "scenes/model/bands.h"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/model/cie_1931.h"
#include "scenes/model/colour.h"

namespace reemit {
namespace {

std::vector<double> centres(double first, double step, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first + step * i);
  return values;
}

TEST(Bands, GreyAndRgbAgreeOnWhite) {
  const BandSet grey = BandSet::grey();
  const BandSet rgb = BandSet::rgb();
  EXPECT_EQ(grey.count(), 1U);
  EXPECT_EQ(rgb.names(), (std::vector<std::string>{"r", "g", "b"}));
  EXPECT_DOUBLE_EQ(grey.efficacy_lm_per_w().sum(), 179.0);
  EXPECT_DOUBLE_EQ(rgb.efficacy_lm_per_w().sum(), 179.0);
  EXPECT_TRUE(grey.to_rgb(Spectrum::Constant(1, 2.5)).isApprox(Eigen::Array3d::Constant(2.5)));
  EXPECT_EQ(rec709_luminance_weights().sum(), 1.0);
}

TEST(Bands, CieTableHasItsLandmarks) {
  EXPECT_DOUBLE_EQ(cie_1931(555)[1], 1.0);
  EXPECT_DOUBLE_EQ(cie_1931(510)[1], 0.503);
  EXPECT_DOUBLE_EQ(cie_1931(512.5)[1], (0.503 + 0.6082) / 2);
  EXPECT_TRUE(cie_1931(300).isZero());
  EXPECT_TRUE(cie_1931(831).isZero());
  EXPECT_TRUE(cie_1931(830).array().isFinite().all());
  // Equal energy is white: the three integrals agree to the accuracy of the standard.
  const Eigen::Vector3d integral = mean_cie_1931(360, 830) * 470;
  EXPECT_NEAR(integral[1], 106.857, 0.01);
  EXPECT_NEAR(integral[0] / integral[1], 1, 5e-4);
  EXPECT_NEAR(integral[2] / integral[1], 1, 5e-4);
}

TEST(Bands, SpectralEfficacyIsThatOfTheBand) {
  EXPECT_DOUBLE_EQ(BandSet::spectral({555}).efficacy_lm_per_w()[0], 683.0);
  EXPECT_EQ(BandSet::spectral({555, 632.8}).name(1), "632.8");
  // Flat spectrum of 1 W/nm over the visible range: 683 x 106.857 lm however it is cut into bands.
  for (const int count : {5, 47, 235}) {
    const double step = 470.0 / count;
    const BandSet bands = BandSet::spectral(centres(360 + step / 2, step, count));
    EXPECT_NEAR((bands.efficacy_lm_per_w() * step).sum(), 683 * 106.857, 683 * 0.02) << count;
  }
}

TEST(Bands, SpectralColourIsNeutralForFlatAndKeepsLuminance) {
  const BandSet bands = BandSet::spectral(centres(400, 10, 31));
  const Eigen::Array3d white = bands.to_rgb(Spectrum::Constant(31, 1.0));
  EXPECT_NEAR(white[0], white[1], 1e-9 * white[1]);
  EXPECT_NEAR(white[2], white[1], 1e-9 * white[1]);
  for (int i = 0; i < 31; ++i) {
    const Spectrum one = Spectrum(Eigen::VectorXd::Unit(31, i));
    const double luminance = (bands.efficacy_lm_per_w() * one).sum();
    EXPECT_NEAR(179 * (rec709_luminance_weights() * bands.to_rgb(one)).sum(), luminance, 1e-9 * 683) << i;
  }
  const Eigen::Array3d red = bands.to_rgb(Spectrum(Eigen::VectorXd::Unit(31, 22)));  // 620 nm
  EXPECT_GT(red[0], 0);
  EXPECT_GT(red[0], red[1]);
  EXPECT_GT(red[0], red[2]);
}

TEST(Bands, RefusesUnorderedCentres) {
  EXPECT_THROW(BandSet::spectral({}), std::invalid_argument);
  EXPECT_THROW(BandSet::spectral({500, 500}), std::invalid_argument);
  EXPECT_THROW(BandSet::spectral({600, 500}), std::invalid_argument);
  EXPECT_THROW(BandSet::spectral({std::nan("")}), std::invalid_argument);
  EXPECT_THROW(BandSet::spectral({-5, 500}), std::invalid_argument);
}

TEST(Bands, EqualityComparesKindAndCentres) {
  EXPECT_TRUE(BandSet::rgb() == BandSet::rgb());
  EXPECT_FALSE(BandSet::rgb() == BandSet::grey());
  EXPECT_FALSE(BandSet::spectral({500, 600}) == BandSet::spectral({500, 610}));
}

TEST(Colour, EqualEnergyWhiteIsNeutralAndLuminanceIsExact) {
  EXPECT_TRUE(rec709_from_chromaticity(1.0 / 3, 1.0 / 3, 0.7).isApprox(Eigen::Array3d::Constant(0.7), 1e-12));
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.45, 0.41}}) {
    const Eigen::Array3d rgb = rec709_from_chromaticity(x, y, 0.3);
    EXPECT_NEAR((rec709_luminance_weights() * rgb).sum(), 0.3, 1e-12);
  }
  // Hues come out where they belong.
  const Eigen::Array3d red = rec709_from_chromaticity(0.64, 0.33, 0.2);
  EXPECT_GT(red[0], 0.5);
  EXPECT_LT(red[1], 0.2);
}

TEST(Colour, GamutClampKeepsLuminance) {
  const Eigen::Array3d green(-0.2, 0.5, -0.1);
  const Eigen::Array3d clamped = clamp_to_gamut(green, 1.0);
  EXPECT_GE(clamped.minCoeff(), 0);
  EXPECT_NEAR((rec709_luminance_weights() * clamped).sum(), (rec709_luminance_weights() * green).sum(),
              1e-12);
  const Eigen::Array3d bright(1.8, 0.6, 0.1);
  const Eigen::Array3d dimmed = clamp_to_gamut(bright, 1.0);
  EXPECT_LE(dimmed.maxCoeff(), 1);
  EXPECT_NEAR((rec709_luminance_weights() * dimmed).sum(), (rec709_luminance_weights() * bright).sum(),
              1e-12);
  const Eigen::Array3d inside(0.1, 0.9, 0.3);
  EXPECT_TRUE((clamp_to_gamut(inside, 1.0) == inside).all() ||
              clamp_to_gamut(inside, 1.0).isApprox(inside, 1e-15));
  EXPECT_TRUE((clamp_to_gamut(Eigen::Array3d(2, 2, 2), 1.0) == 1).all());
}

}  // namespace
}  // namespace reemit
