// What each format says of textures, and what is told where it is wrong.

#include <algorithm>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/common/texture_images.h"
#include "scenes/io/gltf/gltf_reader.h"
#include "scenes/io/obj/obj_reader.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/colour_spectra.h"
#include "tests/scenes/io/gltf_building.h"
#include "tests/support/pixmap.h"

namespace reemit {
namespace {

using nlohmann::json;
using test::expect_input_error;
using test::GltfBuilder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

/// Texture coordinates of a corner of the first surface.
std::array<double, 2> uv_of(const Scene& scene, std::size_t corner) {
  const Surface& s = scene.surfaces.at(0);
  return s.texture_points.at(s.faces.at(0).texture_points.at(corner)).uv[0];
}

Eigen::Vector2d in_image(const Texture& t, double u, double v) {
  return t.to_image * Eigen::Vector3d(u, v, 1);
}

/// Any number of 8-bit channels, in the format of the extension; `tile` > 0: in tiles of so many pixels to a
/// side, where the format has them.
void write_image_file(const std::filesystem::path& file, int width, int height, int channels,
                      const std::vector<unsigned char>& values, int tile = 0) {
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.tile_width = spec.tile_height = tile;
  out->open(file.string(), spec);
  out->write_image(OIIO::TypeDesc::UINT8, values.data());
  out->close();
}

class Textures : public testing::Test {
 protected:
  Scene obj(const std::string& mtl, const std::string& more = "") const {
    folder_.write("room.mtl", mtl);
    return read_obj_scene(
        folder_.write("room.obj",
                      "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                      "vt 1 0.5 0\nvt 0\nusemtl a\nf 1/1 2/2 3/3 4/4\n" +
                          more),
        {});
  }
  Scene native(const std::string& material, const std::string& object = "", const char* bands = "rgb") const {
    const std::string shape =
        object.empty() ? R"("quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]})" : object;
    return read_scene(
        folder_.write("room.json", std::string(R"({"format": "reemit-room", "version": 1, "bands": ")") +
                                       bands + R"(", "materials": {"a": {)" + material +
                                       R"(}}, "objects": [{"material": "a", )" + shape + "}]}"));
  }
  test::TempFolder folder_;
};

TEST_F(Textures, ObjPlacesThemFromTheLowerLeftCornerWithOptions) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 0, 0}, {0, 0, 255}});
  const Scene scene = obj("newmtl a\nKd 0.1 0.1 0.1\nmap_Kd -s 2 3 1 -o 0.25 0.5 0 -clamp on t.ppm\n");
  const Texture& t = scene.materials[0].textures.reflectance;
  ASSERT_TRUE(t);
  EXPECT_TRUE(in_image(t, 0, 0).isApprox(Eigen::Vector2d(0.25, 0.5), 1e-6));
  EXPECT_TRUE(in_image(t, 1, 1).isApprox(Eigen::Vector2d(2.25, -2.5), 1e-6));
  EXPECT_EQ(t.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(uv_of(scene, 2)[1], 0.5);
  EXPECT_EQ(uv_of(scene, 3)[0], 0) << "vt with one number";
}

TEST_F(Textures, ObjMapsOfEmissionAndOpacity) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {0, 0, 0}});
  test::write_pixmap(folder_ / "grey.ppm", 1, 1, {{51, 51, 51}});
  const Scene scene = obj("newmtl a\nKd 1 1 1\nKe 4 4 8\nmap_Ke t.ppm\nd 0.5\nmap_d grey.ppm\n");
  const Material& m = scene.materials[0];
  EXPECT_NEAR(m.emitted_radiance[2], 4, 1e-6);
  EXPECT_NEAR(m.textures.emission_factor[2], 8, 1e-6);
  EXPECT_EQ(m.textures.opacity_factor, 0.5);
  EXPECT_TRUE(m.textures.opacity_is_colour);
  EXPECT_NEAR(m.textures.opacity.image->mean[0], 0.2F, 1e-6F) << "maps of numbers are not decoded";
  EXPECT_FALSE(m.non_diffuse.transmits_specularly()) << "what d takes passes the cut-out, not a clear sheet";
}

TEST_F(Textures, ObjMapOfEmissionStandsForKeWhereThereIsNone) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {0, 0, 0}});
  const Scene scene = obj("newmtl a\nKd 1 1 1\nmap_Ke t.ppm\n");
  EXPECT_NEAR(scene.materials[0].textures.emission_factor[1], 1, 1e-6);
  EXPECT_NEAR(scene.materials[0].emitted_radiance[1], 0.5, 1e-6);
  EXPECT_THAT(scene.notes, ::testing::Contains(::testing::HasSubstr("map_Ke without Ke")));
  EXPECT_FALSE(obj("newmtl a\nKd 1 1 1\nKe 0 0 0\nmap_Ke t.ppm\n").materials[0].emits());
}

TEST_F(Textures, ImagesInTilesAreThoseInRows) {
  constexpr int kWidth = 45;  // neither side is a multiple of the tiles
  constexpr int kHeight = 37;
  std::vector<unsigned char> values;
  for (int i = 0; i < kWidth * kHeight * 3; ++i) values.push_back(static_cast<unsigned char>(i * 7 % 256));
  TextureImages images;
  write_image_file(folder_ / "rows.tif", kWidth, kHeight, 3, values);
  const TextureRead rows = images.from_file(folder_ / "rows.tif", TextureEncoding::kSrgb);
  ASSERT_TRUE(rows.image) << rows.problem;
  for (const char* name : {"tiles.tif", "tiles.exr"}) {
    write_image_file(folder_ / name, kWidth, kHeight, 3, values, 16);
    const TextureRead tiles = images.from_file(folder_ / name, TextureEncoding::kSrgb);
    ASSERT_TRUE(tiles.image) << tiles.problem;
    EXPECT_EQ(tiles.image->width, kWidth);
    EXPECT_EQ(tiles.image->height, kHeight);
    EXPECT_NE(tiles.image->bytes.empty(), tiles.image->texels.empty());
    if (!tiles.image->bytes.empty()) {
      EXPECT_EQ(tiles.image->bytes, rows.image->bytes);
    }
    for (std::size_t i = 0; i < tiles.image->texels.size(); ++i)  // EXR has no 8 bits
      EXPECT_NEAR(tiles.image->texels[i][1], values[3 * i + 1] / 255.0, 1e-3);
  }
}

TEST_F(Textures, ImagesThatAreCutOffAreTold) {
  const std::vector<unsigned char> values(96 * 96 * 3, 77);
  TextureImages images;
  for (const char* name : {"i.jpg", "i.png", "i.tif"}) {
    write_image_file(folder_ / name, 96, 96, 3, values);
    EXPECT_TRUE(images.from_file(folder_ / name, TextureEncoding::kSrgb).image);
    const std::string whole = test::read_bytes(folder_ / name);
    const std::string cut_name = std::string("cut_") + name;
    const TextureRead read = images.from_file(folder_.write(cut_name, whole.substr(0, whole.size() * 4 / 5)),
                                              TextureEncoding::kSrgb);
    EXPECT_FALSE(read.image) << name;
    EXPECT_THAT(read.problem, HasSubstr(cut_name));
  }
}

TEST_F(Textures, BadCoordinatesOfObjFilesAreTold) {
  expect_input_error([&] { obj("newmtl a\n", "vt nan 0\n"); }, {"room.obj:12", "not a finite number"});
  expect_input_error([&] { obj("newmtl a\n", "vt 1 2 3 4\n"); }, {"room.obj:12", "'vt' has 4 numbers"});
  const Scene without = obj("newmtl a\n", "f 1/1 2/9 3/3\n");
  EXPECT_TRUE(without.surfaces[0].faces[1].texture_points.empty());
}

TEST_F(Textures, FacesWithoutCoordinatesCountWithTheMean) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {0, 0, 0}});
  Scene scene = obj("newmtl a\nmap_Kd t.ppm\nKe 1 1 1\n", "f 1 2 3\n");
  finish_scene(scene);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("1 face(s) and 0 round shape(s) have a texture but no")));
  EXPECT_EQ(scene.not_modelled.at("faces_without_texture_coordinates"), 1U);
}

TEST_F(Textures, GltfSamplersTransformsAndSets) {
  test::write_pixmap(folder_ / "t.ppm", 1, 1, {{255, 255, 255}});
  write_image_file(folder_ / "t.png", 2, 1, 4, {255, 255, 255, 255, 255, 0, 0, 0});
  GltfBuilder gltf;
  gltf.square();
  gltf.json["images"] = {{{"uri", "t.png"}}};
  gltf.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  gltf.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  gltf.json["materials"][0] = {{"alphaMode", "MASK"},
                               {"alphaCutoff", 0.25},
                               {"pbrMetallicRoughness",
                                {{"metallicFactor", 0},
                                 {"baseColorFactor", {0.5, 0.5, 0.5, 0.5}},
                                 {"baseColorTexture",
                                  {{"index", 0},
                                   {"texCoord", 0},
                                   {"extensions",
                                    {{"KHR_texture_transform",
                                      {{"offset", {0.5, 0.25}},
                                       {"rotation", std::acos(0.0)},
                                       {"scale", {2, 3}},
                                       {"texCoord", 1}}}}}}}}}};
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      gltf.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      gltf.floats({1, 1, 1, 0.5, 1, 1, 0.5, 0.5, 0.5, 1, 1, 1});
  const Scene scene = read_gltf_scene(folder_.write("room.gltf", gltf.text()), {});
  const MaterialTextures& m = scene.materials[0].textures;
  ASSERT_TRUE(m.reflectance);
  EXPECT_EQ(m.reflectance.set, 1U);
  EXPECT_EQ(m.reflectance.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(m.reflectance.wrap_v, TextureWrap::kMirror);
  EXPECT_TRUE(m.reflectance.nearest);
  // Scaled, then turned by a quarter counter-clockwise as it is seen, v running down; then moved.
  EXPECT_TRUE(in_image(m.reflectance, 1, 0).isApprox(Eigen::Vector2d(0.5, -1.75), 1e-9));
  EXPECT_TRUE(in_image(m.reflectance, 0, 1).isApprox(Eigen::Vector2d(3.5, 0.25), 1e-9));
  EXPECT_TRUE(m.is_cut_out());
  EXPECT_EQ(m.opacity_cutoff, 0.25);
  EXPECT_EQ(m.opacity_factor, 0.5);
  EXPECT_NEAR(scene.materials[0].reflectance[1], 0.25, 1e-6) << "colours are not multiplied by opacity";
  EXPECT_TRUE(scene.surfaces[0].has_vertex_colours);
  EXPECT_EQ(scene.surfaces[0].texture_points[1].colour[0], 0.5F);
  EXPECT_EQ(scene.surfaces[0].texture_points[2].uv[1][1], 1);
}

TEST_F(Textures, GltfTexturesOfExtensionsCountWithTheirMeans) {
  // Half black and half of 0.2 (linear), glossy by 0.2 and 0.6.
  write_image_file(folder_ / "t.png", 2, 1, 4, {0, 0, 0, 51, 124, 124, 124, 153});
  GltfBuilder gltf;
  gltf.square();
  gltf.json["images"] = {{{"uri", "t.png"}}};
  gltf.json["textures"] = {{{"source", 0}}};
  const auto with = [&](const char* extension, const nlohmann::json& values) {
    gltf.json["materials"][0] = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                 {"extensions", {{extension, values}}}};
    return read_gltf_scene(folder_.write("room.gltf", gltf.text()), {});
  };
  const nlohmann::json image = {{"index", 0}};
  const Scene scene = with("KHR_materials_pbrSpecularGlossiness",
                           {{"diffuseFactor", {0.5, 0.5, 0.5, 1}}, {"specularGlossinessTexture", image}});
  const Material& wall = scene.materials[0];
  EXPECT_NEAR(wall.non_diffuse.specular_reflectance[1], 0.1, 2e-3);
  EXPECT_NEAR(wall.reflectance[1], 0.5 * 0.9, 2e-3);
  EXPECT_NEAR(wall.non_diffuse.roughness, 0.6 * 0.6, 2e-3);
  EXPECT_EQ(scene.not_modelled.at("textures"), 1U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("specular-glossiness texture is replaced by its mean")));
  const Scene opal = with("KHR_materials_diffuse_transmission",
                          {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionTexture", image}});
  EXPECT_NEAR(opal.materials[0].non_diffuse.diffuse_transmittance[0], 0.5 * 0.4, 2e-3);
  const Scene coated = with("KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", image}});
  EXPECT_NEAR(coated.materials[0].non_diffuse.specular_reflectance[0], 0.5 * 124 / 255 * 0.04, 2e-4);
}

TEST_F(Textures, GltfCoordinatesOfAnotherNumberAreTold) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      gltf.accessor(std::vector<float>{0, 0, 1, 0}, 5126, "VEC2", 2);
  test::expect_gltf_refused(gltf,
                            {"#/meshes/0/primitives/0/attributes/TEXCOORD_0", "2 values for 4 positions"});
}

TEST_F(Textures, NativeTexturesAndWhatIsWrongWithThem) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 0, 0}, {0, 0, 255}});
  const Scene scene = native(
      R"("reflectance": 0.5, "texture": {"file": "t.ppm", "filter": "nearest", "wrap": ["clamp", "mirror"],
         "scale": [2, 1], "offset": 0.5}, "radiance": 1)");
  const Texture& t = scene.materials[0].textures.reflectance;
  EXPECT_TRUE(t.nearest);
  EXPECT_TRUE(in_image(t, 1, 0).isApprox(Eigen::Vector2d(2.5, 0.5), 1e-12));
  EXPECT_NEAR(scene.materials[0].reflectance[0], 0.25, 1e-6);
  EXPECT_EQ(uv_of(scene, 2)[0], 1) << "a quad has coordinates of its own";
  expect_input_error([&] { native(R"("texture": {"file": "none.png"})"); },
                     {"room.json#/materials/a/texture/file", "none.png"});
  expect_input_error([&] { native(R"("texture": {"file": "t.ppm", "wrap": "tile"})"); },
                     {"/texture/wrap", "repeat"});
  expect_input_error([&] { native(R"("emission_texture": {"file": "t.ppm"})"); },
                     {"/emission_texture", "does not emit"});
  expect_input_error([&] { native(R"("opacity_cutoff": 0.5)"); }, {"/opacity_cutoff", "without a texture"});
  expect_input_error([&] { native(R"("opacity": 1.5)"); }, {"/opacity"});
  expect_input_error(
      [&] {
        native(R"("reflectance": 1)",
               R"("polygon": {"vertices": [[0,0,0],[1,0,0],[0,1,0]], "texture_coordinates": [[0,0],[1,0]]})");
      },
      {"/polygon/texture_coordinates", "2 texture coordinates for 3 vertices"});
  write_image_file(folder_ / "five.tif", 1, 1, 5, {1, 2, 3, 4, 5});
  expect_input_error([&] { native(R"("texture": {"file": "five.tif"})"); }, {"five.tif has 5 channels"});
  const std::string whole = test::read_bytes(folder_ / "t.ppm");
  folder_.write("cut.ppm", whole.substr(0, whole.size() - 3));
  expect_input_error([&] { native(R"("texture": {"file": "cut.ppm"})"); }, {"cut.ppm"});
}

TEST_F(Textures, GreyImagesLeaveOneBandAndColouredOnesDoNot) {
  test::write_pixmap(folder_ / "grey.ppm", 2, 1, {{255, 255, 255}, {7, 7, 7}});
  test::write_pixmap(folder_ / "red.ppm", 2, 1, {{255, 255, 255}, {255, 7, 7}});
  EXPECT_EQ(native(R"("texture": {"file": "grey.ppm"}, "radiance": 1)").bands.count(), 1U);
  EXPECT_EQ(native(R"("texture": {"file": "red.ppm"}, "radiance": 1)").bands.count(), 3U);
  const Scene grey = native(R"("texture": {"file": "red.ppm"}, "radiance": 1)", "", "grey");
  EXPECT_EQ(grey.bands.count(), 1U);
}

/// The spectrum of a texel, or of the colour of a vertex.
Spectrum spectrum_of(const Spectrum& factor, const TexelSpectra& spectra, const Eigen::Array3d& texel) {
  std::vector<float> values(spectra.spectra->band_count());
  const Eigen::Array3f rgb = texel.cast<float>() * spectra.tint;
  spectra.spectra->values({rgb[0], rgb[1], rgb[2]}, values);
  return factor * Eigen::Map<const Eigen::ArrayXf>(values.data(), factor.size()).cast<double>();
}

TEST_F(Textures, TexelsKeepTheirColoursInSpectralBands) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 40, 0}, {30, 60, 255}});
  const std::string material =
      R"("reflectance": [0.8, 0.7, 0.4], "texture": {"file": "t.ppm", "encoding": "linear"},
         "radiance": [3, 2, 1], "emission_texture": {"file": "t.ppm", "encoding": "linear"}, "opacity": 0.5)";
  const Material rgb = native(material).materials.at(0);
  ReadOptions options;
  options.bands = {400, 700, 10};
  const Scene scene = read_scene(folder_ / "room.json", options);
  const Material& spectral = scene.materials.at(0);
  EXPECT_THAT(scene.warnings, testing::Not(Contains(HasSubstr("images"))));
  ASSERT_EQ(scene.bands.count(), 31U);
  const Eigen::Array3d light = rgb.emitted_radiance;
  EXPECT_TRUE(scene.bands.to_rgb(spectral.emitted_radiance).isApprox(light, 1e-6));
  const MaterialTextures& textures = spectral.textures;
  for (const Eigen::Array3d& texel :
       {Eigen::Array3d(1, 40 / 255.0, 0), Eigen::Array3d(30 / 255.0, 60 / 255.0, 1),
        Eigen::Array3d(0.3, 0.3, 0.3)}) {
    const Spectrum radiance = spectrum_of(textures.emission_factor, textures.emission_spectra, texel);
    EXPECT_LT((scene.bands.to_rgb(radiance) - texel * Eigen::Array3d(3, 2, 1)).abs().maxCoeff(), 1e-6);
    EXPECT_GE(radiance.minCoeff(), 0);
    // In the light that the room has, which is not white.
    const Spectrum rho = spectrum_of(textures.reflectance_factor, textures.reflectance_spectra, texel);
    const Eigen::Array3d seen = scene.bands.to_rgb(spectral.emitted_radiance * rho) / light;
    EXPECT_LT((seen - texel * Eigen::Array3d(0.8, 0.7, 0.4)).abs().maxCoeff(), 1e-6);
    EXPECT_GE(rho.minCoeff(), 0);
    EXPECT_LE((rho - textures.most_reflectance).maxCoeff(), 1e-7);
  }
}

TEST_F(Textures, TexelsAndAMirrorStayWithinTheLightInSpectralBands) {
  test::write_pixmap(folder_ / "t.ppm", 3, 1, {{255, 255, 255}, {255, 0, 0}, {20, 255, 30}});
  native(R"("reflectance": 0.7, "texture": {"file": "t.ppm"}, "mirror": [0.1, 0.2, 0.3])");
  ReadOptions options;
  options.bands = {400, 700, 10};
  const Material m = read_scene(folder_ / "room.json", options).materials.at(0);
  EXPECT_LE(m.share_of_light().maxCoeff(), 1);
  for (const Eigen::Array3d& texel : {Eigen::Array3d(1, 1, 1), Eigen::Array3d(1, 0, 0)}) {
    const Spectrum rho = spectrum_of(m.textures.reflectance_factor, m.textures.reflectance_spectra, texel);
    EXPECT_LE((rho - m.textures.most_reflectance).maxCoeff(), 1e-7);
  }
}

TEST_F(Textures, ImagesOfGreyRoomsCountByTheirLuminanceInSpectralBands) {
  test::write_pixmap(folder_ / "t.ppm", 1, 1, {{255, 0, 0}});
  const std::string material =
      R"("reflectance": 0.5, "radiance": 2, "emission_texture": {"file": "t.ppm"}, "texture": {"file": "t.ppm"})";
  const Scene grey = native(material, "", "grey");
  ReadOptions options;
  options.bands = {400, 700, 10};
  const Scene scene = read_scene(folder_ / "room.json", options);
  const MaterialTextures& textures = scene.materials.at(0).textures;
  const Eigen::Array3d red(1, 0, 0);
  EXPECT_TRUE(spectrum_of(textures.reflectance_factor, textures.reflectance_spectra, red)
                  .isApprox(Spectrum::Constant(31, 0.5 * 0.2126), 1e-5));
  const Spectrum radiance = spectrum_of(textures.emission_factor, textures.emission_spectra, red);
  EXPECT_NEAR((radiance * scene.bands.efficacy_lm_per_w()).sum(), 179 * 2 * 0.2126, 1e-3);
}

TEST_F(Textures, ImagesMultiplySpectraInRoomsWithBandsOfTheirOwn) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {255, 0, 0}});
  std::string bands = R"("bands": {"wavelengths_nm": [400)";
  for (int nm = 420; nm <= 700; nm += 20) bands += ", " + std::to_string(nm);
  const Scene scene = read_scene(folder_.write(
      "room.json", R"({"format": "reemit-room", "version": 1, )" + bands + R"(]}, "materials": {"a": {
      "reflectance": {"nm": [400, 700], "value": [0.2, 0.8]}, "texture": {"file": "t.ppm"}}},
      "objects": [{"material": "a", "quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]}}]})"));
  const MaterialTextures& textures = scene.materials.at(0).textures;
  ASSERT_TRUE(textures.reflectance_spectra.spectra);
  const auto at = [&](const Eigen::Array3d& texel) {
    return spectrum_of(textures.reflectance_factor, textures.reflectance_spectra, texel);
  };
  EXPECT_NEAR(at({1, 1, 1})[0], 0.205, 1e-6) << "the mean over the band";
  EXPECT_NEAR(at({1, 1, 1})[15], 0.795, 1e-6);
  EXPECT_NEAR(at({1, 0, 0})[3] / at({1, 1, 1})[3], 0, 0.05) << "red paint in blue light";
  EXPECT_GT(at({1, 0, 0})[15] / at({1, 1, 1})[15], 0.9);
}

TEST_F(Textures, TheHashIsThatOfImageAndCoordinates) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {7, 7, 7}});
  const std::string material = R"("texture": {"file": "t.ppm"}, "radiance": 1)";
  const std::string hash = content_hash(native(material));
  EXPECT_EQ(content_hash(native(material)), hash);
  EXPECT_NE(content_hash(native(R"("texture": {"file": "t.ppm", "scale": 2}, "radiance": 1)")), hash);
  EXPECT_NE(content_hash(native(material, R"("quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0],
      "texture_coordinates": [[0,0],[2,0],[2,1],[0,1]]})")),
            hash);
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {8, 8, 8}});
  EXPECT_NE(content_hash(native(material)), hash);
  const std::string plain = content_hash(native(R"("reflectance": 0.5, "radiance": 1)"));
  EXPECT_EQ(content_hash(native(R"("reflectance": 0.5, "radiance": 1)",
                                R"("quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0],
      "texture_coordinates": [[0,0],[2,0],[2,1],[0,1]]})")),
            plain)
      << "coordinates without a texture say nothing";
}

TEST_F(Textures, TheHashTellsWhetherColoursOfVerticesAreUsed) {
  test::write_pixmap(folder_ / "t.ppm", 2, 1, {{255, 255, 255}, {7, 7, 7}});
  Scene scene = native(R"("texture": {"file": "t.ppm"}, "radiance": 1)");
  Surface& surface = scene.surfaces.front();
  ASSERT_FALSE(surface.texture_points.empty());
  const std::string plain = content_hash(scene);
  for (TexturePoint& point : surface.texture_points) point.colour = {0.25F, 0.5F, 1};
  EXPECT_EQ(content_hash(scene), plain) << "colours that the surface does not show say nothing";
  surface.has_vertex_colours = true;
  EXPECT_NE(content_hash(scene), plain);
}

TEST_F(Textures, CopiesOfAnImageKeepItsMean) {
  std::vector<std::array<int, 3>> pixels;
  for (int i = 0; i < 7 * 5; ++i) pixels.push_back({(i * 37) % 256, (i * 91) % 256, (i * i) % 256});
  test::write_pixmap(folder_ / "odd.ppm", 7, 5, pixels);
  TextureImages images;
  const TextureRead read = images.from_file(folder_ / "odd.ppm", TextureEncoding::kLinear);
  ASSERT_TRUE(read.image) << read.problem;
  double sum = 0;
  for (const auto& p : pixels) sum += p[0] / 255.0 / 35;
  EXPECT_NEAR(static_cast<double>(read.image->mean[0]), sum, 1e-6);
  EXPECT_EQ(read.image->levels.back().texels.size(), 1U);
}

TEST_F(Textures, PlyColoursAndCoordinates) {
  folder_.write(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 255 0 128\n1 0 0 1 0 255 255 255\n0 1 0 0 1 0 0 0\n3 0 1 2\n");
  const std::string file = R"("file": {"path": "m.ply")";
  const Scene scene = native(R"("reflectance": 0.5, "radiance": 1)", file + "}");
  EXPECT_TRUE(scene.surfaces[0].has_vertex_colours);
  EXPECT_NEAR(scene.surfaces[0].texture_points[0].colour[2], 0.2158605F, 1e-6F) << "sRGB";
  EXPECT_EQ(uv_of(scene, 1)[0], 1);
  EXPECT_FALSE(native(R"("reflectance": 0.5, "radiance": 1)", file + R"(, "vertex_colours": false})")
                   .surfaces[0]
                   .has_vertex_colours);
}

}  // namespace
}  // namespace reemit
