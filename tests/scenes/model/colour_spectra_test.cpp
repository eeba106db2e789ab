#include "scenes/model/colour_spectra.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace reemit {
namespace {

using Rgb = Eigen::Array3d;

class ColourSpectraOf : public testing::TestWithParam<Rgb> {
 protected:
  static BandSet ten_nm() {
    std::vector<double> centres;
    for (int nm = 400; nm <= 700; nm += 10) centres.push_back(nm);
    return BandSet::spectral(centres);
  }
  static Spectrum spectrum(const ColourSpectra& spectra, const Rgb& rgb) {
    std::vector<float> values(spectra.band_count());
    spectra.values({static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])},
                   values);
    return Eigen::Map<const Eigen::ArrayXf>(values.data(), static_cast<Eigen::Index>(values.size()))
        .cast<double>();
  }
};

TEST_P(ColourSpectraOf, HaveTheColoursOfTheirLight) {
  const BandSet bands = ten_nm();
  const Upsampling upsampling(bands, GetParam());
  const ColourSpectra spectra(upsampling, bands.count());
  const Spectrum light = Upsampling(bands).emission(GetParam()).values;
  const bool is_white = (GetParam() == 1).all();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double squares = 0;
  constexpr int kColours = 2000;
  for (int i = 0; i < kColours; ++i) {
    const Rgb rgb(uniform(random), uniform(random), uniform(random));
    const Spectrum s = spectrum(spectra, rgb);
    ASSERT_GE(s.minCoeff(), 0);
    ASSERT_LE(s.maxCoeff(), 1);
    const double told = spectra.deviation(
        {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])});
    ASSERT_LT(told, is_white ? 1e-6 : 3e-3) << "corners of the cube in yellow light";
    ASSERT_LT((bands.to_rgb(s * light) / bands.to_rgb(light) - rgb).abs().maxCoeff(),
              2e-6 + told * rgb.maxCoeff());
    squares += (s - upsampling.reflectance(rgb).values).square().mean() / kColours;
  }
  // Near those that each colour would have by itself.
  EXPECT_LT(std::sqrt(squares), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Lights, ColourSpectraOf, testing::Values(Rgb(1, 1, 1), Rgb(1, 0.641, 0.18)));

TEST_F(ColourSpectraOf, GreysAreConstantAndColoursGoTogether) {
  const ColourSpectra spectra(Upsampling(ten_nm()), 31);
  for (const double grey : {0.0, 0.07, 0.18, 0.5, 0.93, 1.0})
    EXPECT_LT((spectrum(spectra, Rgb::Constant(grey)) - grey).abs().maxCoeff(), 1e-6) << grey;
  // From one cell of the lattice to the next there is no step.
  for (double x = 0.05; x < 1; x += 0.05)
    for (int c = 0; c < 3; ++c) {
      Rgb below(0.3, x, 0.6);
      below[c] = 0.625 - 1e-6;
      Rgb above = below;
      above[c] = 0.625 + 1e-6;
      EXPECT_LT((spectrum(spectra, below) - spectrum(spectra, above)).abs().maxCoeff(), 1e-4);
    }
  EXPECT_TRUE(spectrum(spectra, {-1, 2, 0.5}).isApprox(spectrum(spectra, {0, 1, 0.5}), 1e-6));
}

TEST_F(ColourSpectraOf, TooFewBandsAreToldByColour) {
  const BandSet three = BandSet::spectral({450, 550, 650});
  const ColourSpectra spectra(Upsampling(three), 3);
  EXPECT_GT(spectra.deviation({0, 1, 0}), 0.05);
  EXPECT_LT(spectra.deviation({0.4F, 0.4F, 0.4F}), 1e-6);
}

}  // namespace
}  // namespace reemit
