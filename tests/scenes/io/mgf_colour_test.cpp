#include "scenes/io/mgf/mgf_colour.h"

#include <vector>

#include <gtest/gtest.h>

#include "scenes/io/mgf/mgf_material.h"
#include "scenes/model/cie_1931.h"
#include "scenes/model/colour.h"

namespace reemit {
namespace {

void expect_near(const MgfColour& colour, double x, double y, double tolerance) {
  EXPECT_NEAR(colour.x, x, tolerance);
  EXPECT_NEAR(colour.y, y, tolerance);
}

TEST(MgfColour, SpectraHaveTheirChromaticity) {
  const std::vector<double> flat(5, 7.0);
  expect_near(colour_of_spectrum(380, 780, flat), 1.0 / 3, 1.0 / 3, 2e-4);
  expect_near(colour_of_spectrum(554.9, 555.1, std::vector<double>{1, 1}), 0.3374, 0.6588,
              2e-4);  // spectral locus
  // Half the range is dark: only the red end is left.
  const MgfColour red = colour_of_spectrum(580, 780, std::vector<double>{0, 1, 1, 1});
  EXPECT_GT(red.x, 0.6);
  const MgfColour infrared = colour_of_spectrum(900, 1000, flat);
  EXPECT_EQ(infrared, (MgfColour{0, 0}));
  EXPECT_FALSE(is_valid_chromaticity(infrared.x, infrared.y));
}

TEST(MgfColour, BlackBodiesLieOnThePlanckianLocus) {
  expect_near(colour_of_black_body(2856), 0.4476, 0.4074, 3e-4);  // illuminant A
  expect_near(colour_of_black_body(6500), 0.3135, 0.3237, 3e-4);
  expect_near(colour_of_black_body(3000), 0.4369, 0.4041, 3e-4);
}

TEST(MgfColour, MixingWeighsByLuminance) {
  // The primaries and weights of the example of cmix make the white they were chosen for.
  const MgfColour red{0.640, 0.330}, green{0.290, 0.600}, blue{0.150, 0.060};
  const std::vector<std::pair<double, MgfColour>> parts = {{0.265, red}, {0.670, green}, {0.065, blue}};
  expect_near(mix_colours(parts), 1.0 / 3, 1.0 / 3, 2e-3);
  const std::vector<std::pair<double, MgfColour>> same = {{3, green}, {5, green}};
  expect_near(mix_colours(same), green.x, green.y, 1e-12);
}

// The spectrum of daylight is a mean and two components with negative values [CIE04]; a mixture by luminance
// of their colours, two of which no light has, is D65.
TEST(MgfColour, DaylightIsMixedFromItsComponents) {
  const double from = 380, to = 780;
  const std::vector<double> mean = {
      63.4,  65.8,  94.8,  104.8, 105.9, 96.8, 113.9, 125.6, 125.5, 121.3, 121.3, 113.5, 113.1, 110.8,
      106.5, 108.8, 105.3, 104.4, 100,   96,   95.1,  89.1,  90.5,  90.3,  88.4,  84,    85.1,  81.9,
      82.6,  84.9,  81.3,  71.9,  74.3,  76.4, 63.3,  71.7,  77,    65.2,  47.7,  68.6,  65};
  const std::vector<double> first = {
      38.5, 35,  43.4,  46.3, 43.9,  37.1,  36.7,  35.9,  32.6,  27.9,  24.3, 20.1,  16.2,  13.2,
      8.6,  6.1, 4.2,   1.9,  0,     -1.6,  -3.5,  -3.5,  -5.8,  -7.2,  -8.6, -9.5,  -10.9, -10.7,
      -12,  -14, -13.6, -12,  -13.3, -12.9, -10.6, -11.6, -12.2, -10.2, -7.8, -11.2, -10.4};
  const std::vector<double> second = {3,    1.2,  -1.1, -0.5, -0.7, -1.2, -2.6, -2.9, -2.8, -2.6, -2.6,
                                      -1.8, -1.5, -1.3, -1.2, -1,   -0.5, -0.3, 0,    0.2,  0.5,  2.1,
                                      3.2,  4.1,  4.7,  5.1,  6.7,  7.3,  8.6,  9.8,  10.2, 8.3,  9.6,
                                      8.5,  7,    7.6,  8,    6.7,  5.2,  7.4,  6.8};
  const auto luminance = [&](const std::vector<double>& samples) {
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      sum += samples[i] * cie_1931(from + 10.0 * static_cast<double>(i)).y();
    return sum;
  };
  const MgfColour red_green = colour_of_spectrum(from, to, second);
  EXPECT_FALSE(is_valid_chromaticity(red_green.x, red_green.y));
  const std::vector<std::pair<double, MgfColour>> parts = {
      {luminance(mean), colour_of_spectrum(from, to, mean)},
      {-0.295 * luminance(first), colour_of_spectrum(from, to, first)},
      {-0.689 * luminance(second), red_green}};
  expect_near(mix_colours(parts), 0.3127, 0.3290, 5e-4);
}

TEST(MgfColour, ChromaticityLimits) {
  EXPECT_TRUE(is_valid_chromaticity(0, 0.38));
  EXPECT_TRUE(is_valid_chromaticity(0.75, 0.25));
  EXPECT_FALSE(is_valid_chromaticity(0.3, 0));
  EXPECT_FALSE(is_valid_chromaticity(-0.1, 0.3));
  EXPECT_FALSE(is_valid_chromaticity(0.8, 0.3));
}

TEST(MgfMaterialConversion, KeepsPhotometricValuesExactly) {
  MgfMaterial mgf;
  mgf.rd = {0.4, {0.40, 0.38}};
  mgf.ed = {1000, {0.4476, 0.4074}};
  mgf.rs = {0.05, {}};
  mgf.rs_roughness = 0.1;
  std::vector<std::string> warnings;
  const Material m = convert_mgf_material(mgf, "paint", "room:1", warnings);
  const Eigen::Array3d weights = rec709_luminance_weights();
  EXPECT_NEAR((weights * m.reflectance.head<3>()).sum(), 0.4, 1e-12);
  EXPECT_NEAR((weights * m.emitted_radiance.head<3>()).sum() * 179 * 3.14159265358979, 1000, 1e-9);
  EXPECT_GT(m.reflectance[0], m.reflectance[2]);
  EXPECT_TRUE(m.two_sided);
  EXPECT_TRUE(m.emits_both_sides);
  EXPECT_EQ(m.non_diffuse.specular_reflectance.size(), 3);
  EXPECT_EQ(m.non_diffuse.specular_transmittance.size(), 0);
  EXPECT_TRUE(warnings.empty());

  mgf.sides = 1;
  const Material single = convert_mgf_material(mgf, "paint", "room:1", warnings);
  EXPECT_FALSE(single.two_sided);
  EXPECT_FALSE(single.emits_both_sides);
}

TEST(MgfMaterialConversion, NeutralIsExactlyGreyAndImpossibleColoursArePaled) {
  std::vector<std::string> warnings;
  MgfMaterial grey;
  grey.rd = {0.7, {}};
  EXPECT_TRUE((convert_mgf_material(grey, "grey", "room:1", warnings).reflectance == 0.7).all());
  EXPECT_TRUE(warnings.empty());

  MgfMaterial violet;
  violet.rd = {0.5, {0.17, 0.01}};
  violet.rs = {0.7, {0.17, 0.01}};
  violet.ir_imaginary = 3;
  const Material m = convert_mgf_material(violet, "violet", "room:1", warnings);
  EXPECT_GE(m.reflectance.minCoeff(), 0);
  EXPECT_LE(m.reflectance.maxCoeff(), 1);
  EXPECT_NEAR((rec709_luminance_weights() * m.reflectance.head<3>()).sum(), 0.5, 1e-12);
  EXPECT_EQ(warnings.size(), 1U) << "colour";
}

TEST(MgfMaterialConversion, ImaginaryIndicesAreThoseOfMetals) {
  std::vector<std::string> warnings;
  MgfMaterial chrome;
  chrome.rd = {0.1, {}};
  chrome.rs = {0.45, {}};
  chrome.ir_real = 3;
  chrome.ir_imaginary = -3.3;
  const NonDiffusePart metal = convert_mgf_material(chrome, "chrome", "room:1", warnings).non_diffuse;
  EXPECT_EQ(metal.angle_law, AngleLaw::kConductor);
  EXPECT_EQ(metal.metal_eta[0], 3);
  EXPECT_EQ(metal.metal_k[0], 3.3);
  const double normal = (4 + 3.3 * 3.3) / (16 + 3.3 * 3.3);
  EXPECT_NEAR(0.9 * metal.specular_reflectance[0] * normal, 0.45, 1e-12) << "rs is that of normal incidence";
  chrome.rs = {0.6, {}};  // more than Fresnel's equations say
  EXPECT_EQ(convert_mgf_material(chrome, "chrome", "room:1", warnings).non_diffuse.angle_law,
            AngleLaw::kSchlick);
  EXPECT_TRUE(warnings.empty());
}

TEST(MgfMaterialConversion, OneSidedRefractingSurfacesAreBodiesOfGlass) {
  std::vector<std::string> warnings;
  MgfMaterial glass;
  glass.sides = 1;
  glass.ir_real = 1.5;
  glass.rs = {0.04, {}};
  glass.ts = {0.96, {}};
  const NonDiffusePart body = convert_mgf_material(glass, "glass", "room:1", warnings).non_diffuse;
  EXPECT_TRUE(body.is_solid);
  EXPECT_EQ(body.angle_law, AngleLaw::kDielectric);
  EXPECT_NEAR(body.specular_transmittance[0], 1, 1e-12) << "Fresnel's equations explain the 4 %";
  glass.sides = 2;
  const NonDiffusePart sheet = convert_mgf_material(glass, "sheet", "room:1", warnings).non_diffuse;
  EXPECT_FALSE(sheet.is_solid);
  EXPECT_EQ(sheet.angle_law, AngleLaw::kConstant);
  EXPECT_NEAR(sheet.specular_reflectance[0], 0.04, 1e-12);
}

}  // namespace
}  // namespace reemit
