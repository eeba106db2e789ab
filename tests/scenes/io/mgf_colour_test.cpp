#include "scenes/io/mgf_colour.h"

#include <vector>

#include <gtest/gtest.h>

#include "scenes/io/mgf_material.h"
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
  EXPECT_FALSE(is_valid_chromaticity(colour_of_spectrum(900, 1000, flat).x, 0.3));
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
  EXPECT_EQ(warnings.size(), 3U) << "colour, sum above 1, imaginary index";
}

}  // namespace
}  // namespace reemit
