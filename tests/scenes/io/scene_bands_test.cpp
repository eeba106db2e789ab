// Rooms of colours in spectral bands: by option, and files with colours in a spectral JSON room.
#include "scenes/io/common/scene_bands.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "tests/scenes/io/gltf_building.h"
#include "tests/scenes/io/library_folder.h"
#include "tests/scenes/io/native_reading.h"

namespace reemit {
namespace {

using Rgb = Eigen::Array3d;
using test::kLibrary;
using ::testing::Contains;
using ::testing::HasSubstr;

const SpectralBands kBands{400, 700, 10};

Scene read_with_bands(const std::filesystem::path& file, const SpectralBands& bands = kBands) {
  ReadOptions options;
  options.bands = bands;
  return read_scene(file, options);
}

const Material& named(const Scene& scene, const std::string& name) {
  for (const Material& material : scene.materials)
    if (material.name == name) return material;
  throw std::runtime_error("no material " + name);
}

TEST(SpectralBands, AreReadFromText) {
  EXPECT_EQ(parse_spectral_bands("400:700:10"), kBands);
  EXPECT_EQ(parse_spectral_bands("400:700:10").centres_nm().size(), 31u);
  EXPECT_EQ(parse_spectral_bands("400:700:0.3").centres_nm().back(), 700);
  EXPECT_EQ(parse_spectral_bands("400:709:10").centres_nm().back(), 700);
  EXPECT_EQ(parse_spectral_bands("380.5:780:2.5").text(), "380.5:780:2.5");
  for (const char* text : {"", "400", "400:700", "400:700:10:", "400:700:", "400:700:-10", "400:700:1e-9",
                           "400:1e7:10", "0:700:10", "inf:700:10", "400:401:10"})
    EXPECT_THROW(parse_spectral_bands(text), std::invalid_argument) << text;
}

// The lamp lights every wall in the colour that the RGB room has.
TEST(SceneBands, DirectLightInTheCornellBoxIsThatOfTheRgbRoom) {
  const Scene rgb = read_scene(kLibrary / "cornell_box.json");
  const Scene spectral = read_with_bands(kLibrary / "cornell_box.json");
  ASSERT_EQ(spectral.bands, BandSet::spectral(kBands.centres_nm()));
  EXPECT_THAT(spectral.notes, Contains(HasSubstr("red : green : blue 1 : 0.641 : 0.18")));
  const Spectrum& lamp = named(spectral, "lamp").emitted_radiance;
  const Rgb emitted = named(rgb, "lamp").emitted_radiance;
  EXPECT_TRUE(spectral.bands.to_rgb(lamp).isApprox(emitted, 1e-10));
  for (const char* name : {"white", "green", "red", "lamp"}) {
    const Rgb expected = emitted * Rgb(named(rgb, name).reflectance);
    const Rgb sent = spectral.bands.to_rgb(lamp * named(spectral, name).reflectance);
    EXPECT_TRUE(sent.isApprox(expected, 1e-10)) << name << ": " << sent.transpose();
    EXPECT_NEAR((spectral.bands.efficacy_lm_per_w() * lamp * named(spectral, name).reflectance).sum(),
                (rgb.bands.efficacy_lm_per_w() * expected).sum(), 1e-6);
  }
}

TEST(SceneBands, LightsAndGreyRoomsKeepTheirLuminance) {
  const test::TempFolder folder;
  const auto file =
      folder.write("room.json", test::room(R"("bands": "grey", "materials": {"white": {"reflectance": 0.5}},
      "objects": [{"material": "white", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}}],
      "lights": [{"type": "point", "position": [0.5, 0.5, 0.5], "intensity_cd": 100}])"));
  const Scene scene = read_with_bands(file);
  const Spectrum& intensity = std::get<PointLight>(scene.lights[0]).intensity;
  EXPECT_NEAR((intensity * scene.bands.efficacy_lm_per_w()).sum(), 100, 1e-9);
  EXPECT_TRUE((intensity == intensity[0]).all());
  EXPECT_TRUE((named(scene, "white").reflectance == 0.5).all());
  EXPECT_THAT(scene.notes, Contains(HasSubstr("their colours in equal-energy white")));
  EXPECT_THAT(scene.notes, testing::Not(Contains(HasSubstr("one grey band"))));
}

// Gloss beside a colour whose red is nearly all of the light: the sum stays below 1 in every band.
TEST(SceneBands, SharesStayWithinTheLight) {
  const test::TempFolder folder;
  const auto file = folder.write("room.json", test::room(R"("bands": "rgb", "materials": {
        "red": {"reflectance": [0.9, 0.02, 0.02], "mirror": 0.08},
        "both": {"reflectance": [0.2, 0.3, 0.1], "back_reflectance": [0.1, 0.1, 0.6], "diffuse_transmittance": [0.3, 0.2, 0.25]},
        "glass": {"glass": {"ior": 1.5, "transmittance": [0.9, 0.95, 0.99], "solid": true, "transmittance_per_m": [0.5, 1e-30, 0.9]}},
        "gold": {"metal": "gold"}, "lamp": {"radiance": [3, 2, 1]}},
      "objects": [{"material": "red", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}},
                  {"material": "both", "quad": {"corner": [0.1, 0.5, 0.1], "u": [0.1, 0, 0], "v": [0, 0, 0.1]}},
                  {"material": "gold", "quad": {"corner": [0.3, 0.5, 0.1], "u": [0.1, 0, 0], "v": [0, 0, 0.1]}},
                  {"material": "glass", "sphere": {"center": [0.7, 0.5, 0.7], "radius": 0.1}},
                  {"material": "lamp", "quad": {"corner": [0.1, 0.9, 0.1], "u": [0.1, 0, 0], "v": [0, 0, 0.1]}}])"));
  const Scene scene = read_with_bands(file);
  EXPECT_THAT(scene.warnings, testing::Not(Contains(HasSubstr("more than it gets"))));
  const Scene rgb = read_scene(file);
  const Spectrum& lamp = named(scene, "lamp").emitted_radiance;
  const Rgb light = named(rgb, "lamp").emitted_radiance;
  const auto same = [&](const Spectrum& spectrum, const Spectrum& colour) {
    EXPECT_TRUE((scene.bands.to_rgb(lamp * spectrum) / light).isApprox(Rgb(colour), 1e-9));
  };
  for (const char* name : {"red", "both"}) {
    EXPECT_LE(named(scene, name).share_of_light().maxCoeff(), 1) << name;
    same(named(scene, name).reflectance, named(rgb, name).reflectance);
  }
  same(named(scene, "both").back_reflectance, named(rgb, "both").back_reflectance);
  same(named(scene, "both").non_diffuse.diffuse_transmittance,
       named(rgb, "both").non_diffuse.diffuse_transmittance);
  same(named(scene, "glass").non_diffuse.specular_transmittance,
       named(rgb, "glass").non_diffuse.specular_transmittance);
  const Spectrum& absorption = named(scene, "glass").non_diffuse.absorption_per_m;
  ASSERT_EQ(absorption.size(), 31);
  EXPECT_TRUE(absorption.isFinite().all() && (absorption >= 0).all());
  EXPECT_GT(absorption[15], 20);  // 550 nm; of green 30 ln 10 = 69 per metre
  const NonDiffusePart& gold = named(scene, "gold").non_diffuse;
  EXPECT_NEAR(gold.metal_eta[0], named(rgb, "gold").non_diffuse.metal_eta[2], 1e-12);
  EXPECT_NEAR(gold.metal_k[30], named(rgb, "gold").non_diffuse.metal_k[0], 1e-12);
  EXPECT_TRUE((gold.specular_reflectance == 1).all());
}

TEST(SceneBands, ALampOfOnePrimaryDoesNotSayWhatWallsReflect) {
  const test::TempFolder folder;
  const auto file = folder.write(
      "room.json",
      test::room(
          R"("bands": "rgb", "materials": {"green": {"reflectance": [0, 1, 0]}, "lamp": {"radiance": [5, 0, 0.1]}},
      "objects": [{"material": "green", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}},
                  {"material": "lamp", "quad": {"corner": [0.1, 0.9, 0.1], "u": [0.1, 0, 0], "v": [0, 0, 0.1]}}])"));
  EXPECT_THAT(read_with_bands(file).notes, Contains(HasSubstr("their colours in equal-energy white")));
  EXPECT_THAT(read_with_bands(file, {450, 650, 100}).warnings,
              Contains(HasSubstr("The bands 450:650:100 nm are too few")));
}

TEST(SceneBands, ARoomWithBandsOfItsOwnKeepsThem) {
  const std::string message =
      test::refusal_of([] { read_with_bands(kLibrary / "cornell_box_spectral.json"); });
  EXPECT_THAT(message, testing::AllOf(HasSubstr("15 spectral bands of its own"), HasSubstr("--bands")));
  const Scene own = read_scene(kLibrary / "cornell_box_spectral.json");
  const std::vector<double>& centres = own.bands.centres_nm();
  const Scene same = read_with_bands(kLibrary / "cornell_box_spectral.json",
                                     {centres.front(), centres.back(), centres[1] - centres[0]});
  EXPECT_EQ(content_hash(same), content_hash(own));
}

constexpr const char* kSpectralRoom =
    R"("bands": {"wavelengths_nm": [400, 410, 420, 430, 440, 450, 460, 470, 480, 490,
  500, 510, 520, 530, 540, 550, 560, 570, 580, 590, 600, 610, 620, 630, 640, 650, 660, 670, 680, 690, 700]}, )";

TEST(SceneBands, ColoursInASpectralRoom) {
  const Scene scene = test::read_text(test::room(kSpectralRoom + std::string(R"("materials": {
        "a": {"reflectance": {"rgb": [0.2, 0.4, 0.6]}}, "b": {"reflectance": {"srgb": "#804020"}},
        "c": {"radiance": {"rgb": [9, 4, 1]}}, "d": {"luminance_cd_m2": 500, "emission_color": {"srgb": "#ffd0a0"}}})")));
  const Spectrum white = Spectrum::Constant(31, 10);
  const auto colour = [&](const Spectrum& s) {
    return Rgb(scene.bands.to_rgb(s * white) / scene.bands.to_rgb(white));
  };
  EXPECT_TRUE(colour(named(scene, "a").reflectance).isApprox(Rgb(0.2, 0.4, 0.6), 1e-10));
  const double decoded = std::pow((0x80 / 255.0 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(colour(named(scene, "b").reflectance)[0], decoded, 1e-10);
  EXPECT_TRUE(scene.bands.to_rgb(named(scene, "c").emitted_radiance).isApprox(Rgb(9, 4, 1), 1e-10));
  const Spectrum& lamp = named(scene, "d").emitted_radiance;
  EXPECT_NEAR((lamp * scene.bands.efficacy_lm_per_w()).sum(), 500, 1e-9);
  EXPECT_GT(lamp[30], lamp[0]);

  const auto refused = [](const std::string& fields, std::initializer_list<const char*> parts) {
    test::expect_refused(test::room(kSpectralRoom + std::string(R"("materials": {"m": {)") + fields + "}}"),
                         parts);
  };
  refused(R"("reflectance": [0.1, 0.2, 0.3])",
          {"#/materials/m/reflectance", "3 values for 31 bands", "{\"rgb\": [r, g, b]}"});
  refused(R"("reflectance": {"rgb": [0.1, 0.2]})", {"#/materials/m/reflectance/rgb", "2 values, expected 3"});
  refused(R"("reflectance": {"rgb": [0.1, 1.2, 0.2]})", {"#/materials/m/reflectance/rgb/1", "out of range"});
  refused(R"("radiance": {"rgb": [0.1, -1, 0.2]})", {"#/materials/m/radiance/rgb/1"});
  refused(R"("reflectance": {"rgb": [0.1, 0.1, 0.2], "nm": 3})", {"#/materials/m/reflectance", "nm"});
  refused(R"("metal": {"eta": {"rgb": [1, 1, 2]}, "k": 2})",
          {"#/materials/m/metal/eta", "no spectrum of eta or k"});
  test::expect_refused(
      test::room(
          R"("bands": {"wavelengths_nm": [450, 550, 650]}, "materials": {"m": {"reflectance": {"srgb": "#00ff00"}}})"),
      {"#/materials/m/reflectance", "3 bands of the room are too few for this colour"});
}

TEST(SceneBands, ColoursOfAnRgbTripleInRgbAndGreyRooms) {
  const auto reflectance = [](const std::string& bands) {
    return test::read_text(test::room("\"bands\": " + bands +
                                      R"(, "materials": {"a": {"reflectance": {"rgb": [0.2, 0.4, 0.6]}}})"))
        .materials[0]
        .reflectance;
  };
  EXPECT_TRUE(reflectance(R"("rgb")").isApprox(Rgb(0.2, 0.4, 0.6), 1e-15));
  EXPECT_NEAR(reflectance(R"("grey")")[0], 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.6, 1e-12);
}

TEST(SceneBands, FilesWithColoursInASpectralRoom) {
  const test::TempFolder folder;
  test::GltfBuilder gltf;
  gltf.square();
  gltf.json["materials"][0] = {
      {"name", "paint"},
      {"emissiveFactor", {1, 0.5, 0.25}},
      {"pbrMetallicRoughness", {{"baseColorFactor", {0.7, 0.3, 0.2, 1}}, {"metallicFactor", 0}}}};
  folder.write("square.gltf", gltf.text());
  const auto read = [&](const std::string& bands) {
    return read_scene(folder.write(
        "room.json",
        test::room(bands + R"("materials": {}, "objects": [{"file": {"path": "square.gltf"}}])")));
  };
  const Scene scene = read(kSpectralRoom);
  const Spectrum white = Spectrum::Constant(31, 10);
  const Material& paint = named(scene, "paint");
  EXPECT_TRUE((scene.bands.to_rgb(paint.reflectance * white) / scene.bands.to_rgb(white))
                  .isApprox(0.96 * Rgb(0.7, 0.3, 0.2) + 0.04, 0.2));
  EXPECT_TRUE(scene.bands.to_rgb(paint.emitted_radiance).isApprox(Rgb(1, 0.5, 0.25) / 179, 1e-10));
  EXPECT_THAT(read(R"("bands": {"wavelengths_nm": [450, 550, 650]}, )").warnings,
              testing::Each(testing::Not(HasSubstr("too few"))));
}

}  // namespace
}  // namespace reemit
