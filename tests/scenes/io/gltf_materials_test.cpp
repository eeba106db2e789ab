#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/io/gltf_building.h"
#include "tests/support/encoded_image.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using nlohmann::json;
using test::expect_gltf_refused;
using test::GltfBuilder;
using test::read_gltf;
using testing::Contains;
using testing::HasSubstr;

GltfBuilder with_material(const json& material) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["materials"][0] = material;
  return gltf;
}

Material read_material(const json& material, const ReadOptions& options = {}) {
  return read_gltf(with_material(material), options).materials.at(0);
}

TEST(GltfMaterials, MetallicPartIsNotDiffuse) {
  const Material m = read_material(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.3}}}});
  EXPECT_NEAR(m.reflectance[0], 0.6, 1e-12);
  EXPECT_NEAR(m.non_diffuse.specular_reflectance[1], 0.1, 1e-12);
  EXPECT_NEAR(m.non_diffuse.roughness, 0.09, 1e-12) << "alpha is the square of the factor";
  EXPECT_EQ(m.non_diffuse.angle_law, AngleLaw::kSchlick);
  const Material by_default = read_material(json::object());
  EXPECT_TRUE((by_default.reflectance == 0).all());  // glTF materials are metallic unless they say otherwise.
  EXPECT_TRUE((by_default.non_diffuse.specular_reflectance == 1).all());
}

TEST(GltfMaterials, UnlitOnesHaveTheirBaseColourAndNoMetal) {
  const Material m = read_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.2, 0, 1}}}},
                                    {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  EXPECT_TRUE(m.reflectance.isApprox(Eigen::Array3d(1, 0.2, 0), 1e-12));
  EXPECT_FALSE(m.non_diffuse.reflects_specularly());
}

TEST(GltfMaterials, TransmissionAndSpecularGlossiness) {
  const Material glass = read_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                        {"extensions",
                                         {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                                          {"KHR_materials_ior", {{"ior", 1.4}}}}}});
  EXPECT_NEAR(glass.reflectance[0], 0.1, 1e-12);
  EXPECT_NEAR(glass.non_diffuse.specular_transmittance[0], 0.9, 1e-12);
  EXPECT_EQ(glass.non_diffuse.index_of_refraction, 1.4);
  EXPECT_EQ(glass.non_diffuse.angle_law, AngleLaw::kDielectric);
  EXPECT_FALSE(glass.non_diffuse.is_solid);
  const Material body = read_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 0.1}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.25, 0.5, 1}}}}}}});
  EXPECT_TRUE(body.non_diffuse.is_solid);
  EXPECT_NEAR(body.non_diffuse.absorption_per_m[0], 2 * std::log(4.0), 1e-12);
  EXPECT_NEAR(body.non_diffuse.absorption_per_m[2], 0, 1e-12);
  const Material old = read_material({{"extensions",
                                       {{"KHR_materials_pbrSpecularGlossiness",
                                         {{"diffuseFactor", {0.3, 0.4, 0.5, 1}},
                                          {"specularFactor", {0.6, 0.1, 0.1}},
                                          {"glossinessFactor", 0.75}}}}}});
  EXPECT_NEAR(old.reflectance[2], 0.5 * 0.4, 1e-12);
  EXPECT_NEAR(old.non_diffuse.specular_reflectance[0], 0.6, 1e-12);
  EXPECT_EQ(old.non_diffuse.angle_law, AngleLaw::kSchlick);
  EXPECT_NEAR(old.non_diffuse.roughness, 0.0625, 1e-12);
}

TEST(GltfMaterials, GlossOfDielectricsIsThatOfTheirExtensions) {
  const auto plastic = [](const json& extensions) {
    return read_material(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
         {"extensions", extensions}});
  };
  const Material unsaid = plastic(json::object());
  EXPECT_EQ(unsaid.non_diffuse.specular_reflectance.size(), 0);
  EXPECT_EQ(unsaid.reflectance[0], 0.5);
  const Material plain = plastic({{"KHR_materials_specular", json::object()}});
  EXPECT_NEAR(plain.non_diffuse.specular_reflectance[0], 0.04, 1e-12);
  EXPECT_NEAR(plain.reflectance[0], 0.5 * 0.96, 1e-12);
  EXPECT_NEAR(plain.non_diffuse.roughness, 0.25, 1e-12);
  EXPECT_EQ(plain.non_diffuse.angle_law, AngleLaw::kSchlick);
  const Material tinted =
      plastic({{"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {2, 1, 0}}}},
               {"KHR_materials_ior", {{"ior", 2}}}});
  EXPECT_NEAR(tinted.non_diffuse.specular_reflectance[0], 1.0 / 9, 1e-12);
  EXPECT_NEAR(tinted.non_diffuse.specular_reflectance[1], 0.5 / 9, 1e-12);
  EXPECT_EQ(tinted.non_diffuse.specular_reflectance[2], 0);
  EXPECT_NEAR(tinted.reflectance[2], 0.5 * (1 - 1.0 / 9), 1e-12);
  const Material none = plastic({{"KHR_materials_specular", {{"specularFactor", 0}}}});
  EXPECT_EQ(none.non_diffuse.specular_reflectance.size(), 0);
  const Material coated =
      plastic({{"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.2}}}});
  EXPECT_NEAR(coated.non_diffuse.specular_reflectance[0], 0.02, 1e-12);
  EXPECT_NEAR(coated.non_diffuse.roughness, 0.04, 1e-12);
  EXPECT_NEAR(coated.reflectance[0], 0.5 * 0.98, 1e-12);
}

TEST(GltfMaterials, ClearCoatsOnMetalAreToldOf) {
  const Scene scene = read_gltf(with_material(
      {{"name", "car"}, {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}}));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("\"car\": the clear coat on its metal is ignored")));
  EXPECT_EQ(scene.not_modelled.at("clear_coats"), 1U);
}

TEST(GltfMaterials, EmissionAndItsUnits) {
  const json lamp = {{"emissiveFactor", {1, 0.5, 0}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 358}}}}}};
  const Material photometric = read_material(lamp);
  EXPECT_NEAR(photometric.emitted_radiance[0], 2, 1e-12);
  EXPECT_NEAR(photometric.emitted_radiance[1], 1, 1e-12);
  EXPECT_FALSE(photometric.emits_both_sides);
  ReadOptions watts;
  watts.gltf_emissive_units = EmissiveUnits::kWatt;
  EXPECT_NEAR(read_material(lamp, watts).emitted_radiance[0], 358, 1e-12);
  EXPECT_THAT(read_gltf(with_material(lamp)).notes,
              Contains(HasSubstr("cd/m2 and divided by 179 lm/W, as the specification says")));
  EXPECT_THAT(read_gltf(with_material(lamp), watts).notes, Contains(HasSubstr("W/(sr m2)")));
  json both = lamp;
  both["doubleSided"] = true;
  EXPECT_TRUE(read_material(both).two_sided);
  EXPECT_TRUE(read_material(both).emits_both_sides);
}

TEST(GltfMaterials, NoMaterialIsGrey) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["meshes"][0]["primitives"][0].erase("material");
  const Scene scene = read_gltf(gltf);
  EXPECT_TRUE((scene.material_of(scene.surfaces.at(0)).reflectance == 0.5).all());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("have no material")));
}

TEST(GltfMaterials, RefusesWrongValues) {
  expect_gltf_refused(
      with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.5, 0, 0, 1}}}}}),
      {"room.gltf#/materials/0/pbrMetallicRoughness/baseColorFactor: ", "baseColorFactor is 1.5"});
  expect_gltf_refused(with_material({{"pbrMetallicRoughness", {{"metallicFactor", -1}}}}),
                      {"#/materials/0/pbrMetallicRoughness/metallicFactor: metallicFactor is -1"});
  expect_gltf_refused(with_material({{"emissiveFactor", {-1, 0, 0}}}),
                      {"#/materials/0/emissiveFactor: emissiveFactor is -1"});
  expect_gltf_refused(with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 3}}}}}}),
                      {"#/materials/0/pbrMetallicRoughness/baseColorTexture: there is no texture 3"});
  expect_gltf_refused(
      with_material({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 2}}}}}}),
      {"#/materials/0/extensions/KHR_materials_transmission/transmissionFactor: "});
  expect_gltf_refused(
      with_material({{"extensions",
                      {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.5, 0.5, -0.5, 1}}}}}}}),
      {"#/materials/0/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor: "});
}

// The parser takes its defaults for what it cannot read, for a whole block of values where one is wrong.
TEST(GltfMaterials, RefusesValuesOfTheWrongKind) {
  expect_gltf_refused(
      with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.4, 0.2}}}}}),
      {"#/materials/0/pbrMetallicRoughness/baseColorFactor: there are 3 numbers in place of 4"});
  expect_gltf_refused(with_material({{"alphaCutoff", "0.2"}}), {"#/materials/0/alphaCutoff: "});
  expect_gltf_refused(with_material({{"alphaMode", "mask"}}), {"#/materials/0/alphaMode: ", "MASK"});
  expect_gltf_refused(with_material({{"extensions", {{"KHR_materials_emissive_strength", 1000}}}}),
                      {"#/materials/0/extensions/KHR_materials_emissive_strength: "});
}

/// A PNG of one black and three white texels.
std::string checker_png(const test::TempFolder& folder) {
  const std::vector<unsigned char> texels{0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 128, 0};
  const ImageDescription description{"png", 2, 2, {"R", "G", "B"}, PixelType::kByte};
  const std::string bytes = test::encoded_image(description, texels.data());
  folder.write("checker.png", bytes);
  return bytes;
}

TEST(GltfMaterials, TexturesHaveTheirLinearMean) {
  const test::TempFolder folder;
  const std::string png = checker_png(folder);
  GltfBuilder gltf = with_material(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 1, 1, 1}}, {"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}});
  gltf.json["textures"] = {{{"source", 0}}};
  const double green = (2 + 0.2158605) / 4;  // 128/255 decoded by IEC 61966-2-1.
  const auto check = [&](const Scene& scene) {
    EXPECT_NEAR(scene.materials[0].reflectance[0], 0.375, 1e-6);
    EXPECT_NEAR(scene.materials[0].reflectance[1], green, 1e-6);
    EXPECT_NEAR(scene.materials[0].reflectance[2], 0.5, 1e-6);
    ASSERT_TRUE(scene.materials[0].textures.reflectance);
    EXPECT_EQ(scene.materials[0].textures.reflectance_factor[0], 0.5);
  };
  gltf.json["images"] = {{{"uri", "checker.png"}}};
  const std::filesystem::path room = folder.write("room.gltf", gltf.text());
  check(read_gltf_scene(room, {}));
  EXPECT_THAT(read_scene(room).files, Contains(HasSubstr("checker.png")));
  gltf.json["images"] = {{{"uri", "data:image/png;base64," + test::base64(png)}}};
  check(read_gltf_scene(folder.write("room.gltf", gltf.text()), {}));
  gltf.json["images"] = {
      {{"bufferView", gltf.view(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}};
  check(read_gltf_scene(folder.write("room.glb", gltf.glb()), {}));
}

TEST(GltfMaterials, UnreadableTexturesCountAsWhite) {
  GltfBuilder gltf = with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}});
  gltf.json["textures"] = {{{"source", 0}}};
  for (const char* uri : {"missing.png", "data:image/png;base64,iVBORw0KGgoAAAAN", "/dev/zero"}) {
    gltf.json["images"] = {{{"uri", uri}}};
    const Scene scene = read_gltf(gltf);
    EXPECT_EQ(scene.materials[0].reflectance[0], 1) << uri;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("texture counts as white"))) << uri;
  }
}

}  // namespace
}  // namespace reemit
