// Rooms compressed by the encoders that are in use (tests/hard/make_compressed_seeds.py made them): they are
// the room they were made from, up to quantisation, and whatever is broken in them is refused at its place.
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "tests/scenes/io/face_area.h"
#include "tests/scenes/io/gltf_building.h"

namespace reemit {
namespace {

using nlohmann::json;
using test::GltfBuilder;
using test::TempFolder;

const std::filesystem::path kSeeds = std::filesystem::path(REEMIT_SOURCE_DIR) / "tests" / "hard" / "seeds";
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

Scene read_seed(const std::string& name) {
  return read_gltf_scene(kSeeds / name, {});
}

const Surface& surface_named(const Scene& scene, const std::string& name) {
  for (const Surface& surface : scene.surfaces)
    if (surface.name == name) return surface;
  throw std::runtime_error("no surface " + name);
}

double area_of(const Surface& surface) {
  double sum = 0;
  for (const Face& face : surface.faces) sum += test::area_vector(surface, face).norm();
  return sum;
}

/// Of a closed shell that looks outwards, whatever the order of its faces.
double volume_of(const Surface& shell) {
  double volume = 0;
  for (const Face& face : shell.faces)
    volume += test::area_vector(shell, face).dot(shell.positions[face.outer[0]]) / 3;
  return volume;
}

/// A GLB file in its parts.
struct Glb {
  json document;
  std::string binary;

  explicit Glb(const std::string& name) {
    const std::string bytes = test::read_bytes(kSeeds / name);
    const std::size_t length = word_at(bytes, 12);
    document = json::parse(bytes.substr(20, length));
    binary = bytes.substr(28 + length);
  }

  std::string bytes() const {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
  }

 private:
  static std::size_t word_at(const std::string& bytes, std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
  }
  static std::string word(std::size_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
    return bytes;
  }
};

Scene read_glb(const Glb& glb) {
  const TempFolder folder;
  return read_gltf_scene(folder.write("room.glb", glb.bytes()), {});
}

/// The value at `pointer` becomes `value`, and the file is refused with all `parts`.
void expect_change_refused(const std::string& seed, const std::string& pointer, const json& value,
                           std::initializer_list<const char*> parts) {
  SCOPED_TRACE(pointer + " = " + value.dump());
  Glb glb(seed);
  glb.document[json::json_pointer(pointer)] = value;
  test::expect_input_error([&] { read_glb(glb); }, parts);
}

class CompressedRoom : public testing::TestWithParam<const char*> {};

TEST_P(CompressedRoom, IsTheRoomThatWasCompressed) {
  const Scene plain = read_seed("ball.glb");
  const Scene compressed = read_seed(GetParam());
  // And that the program that compressed it took out the name of the one that made it.
  ASSERT_THAT(compressed.warnings, testing::SizeIs(plain.warnings.size() + 1));
  EXPECT_THAT(compressed.warnings.back(), testing::HasSubstr("rewrote the file"));
  ASSERT_EQ(compressed.surfaces.size(), plain.surfaces.size());
  // Half a step of 11 bits over 2 m, the coarsest of these files, for each corner.
  constexpr double kStep = 2.0 / (1 << 11);
  for (const Surface& expected : plain.surfaces) {
    SCOPED_TRACE(expected.name);
    const Surface& surface = surface_named(compressed, expected.name);
    EXPECT_EQ(surface.faces.size(), expected.faces.size());
    EXPECT_NEAR(area_of(surface), area_of(expected), 6 * kStep * std::sqrt(area_of(expected)));
    EXPECT_EQ(compressed.material_of(surface).name, plain.material_of(expected).name);
    ASSERT_EQ(surface.normals.size(), surface.positions.size());
    if (expected.name != "ball") continue;
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
      const Vec3 out = surface.positions[i].normalized();
      EXPECT_NEAR(surface.positions[i].norm(), 0.4, kStep);
      EXPECT_NEAR(out.dot(surface.normals[i].normalized()), 1, 1e-3);  // 8 bits of a normal: 0.5 degree
    }
  }
  EXPECT_NEAR(volume_of(surface_named(compressed, "ball")), volume_of(surface_named(plain, "ball")), 0.003);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CompressedRoom,
                         testing::Values("ball_draco.glb", "ball_draco_sequential.glb", "ball_meshopt.glb",
                                         "ball_packed.gltf", "ball_webp.glb"),
                         [](const auto& seed) {
                           const std::string name = seed.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(GltfCompression, WebpTexturesAreRead) {
  const Spectrum expected = read_seed("ball.glb").materials[2].reflectance;
  const Spectrum webp = read_seed("ball_webp.glb").materials[2].reflectance;
  EXPECT_LT(expected.minCoeff(), 0.8 * expected.maxCoeff());
  EXPECT_TRUE(webp.isApprox(expected, 1e-12)) << webp.transpose();  // lossless
}

TEST(GltfCompression, WebpInADataUriIsRead) {
  Glb glb("ball_webp.glb");
  const json view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"].get<std::size_t>()];
  const std::string bytes =
      glb.binary.substr(view.value("byteOffset", std::size_t{0}), view["byteLength"].get<std::size_t>());
  glb.document["images"][0] = {{"uri", "data:image/webp;base64," + test::base64(bytes)}};
  EXPECT_TRUE(
      read_glb(glb).materials[2].reflectance.isApprox(read_seed("ball.glb").materials[2].reflectance, 1e-12));
}

TEST(GltfCompression, GeometryThatIsThereTwiceIsReadOnce) {
  // The accessors have bytes of their own, for programs that cannot decode: Draco data are not looked at.
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensionsUsed"] = {kDraco};
  gltf.json["meshes"][0]["primitives"][0]["extensions"][kDraco] = {{"bufferView", 99},
                                                                   {"attributes", {{"POSITION", 0}}}};
  EXPECT_NEAR(test::total_area(test::read_gltf(gltf)), 1, 1e-9);
}

TEST(GltfCompression, BrokenDracoIsRefusedAtItsPlace) {
  const auto refused = [](const std::string& pointer, const json& value,
                          std::initializer_list<const char*> parts) {
    for (const char* seed : {"ball_draco.glb", "ball_draco_sequential.glb"})
      expect_change_refused(seed, pointer, value, parts);
  };
  const std::string primitive = "/meshes/2/primitives/0";
  const std::string extension = primitive + "/extensions/" + kDraco;
  refused(extension + "/bufferView", 99, {"#/meshes/2/primitives/0/extensions/KHR", "no buffer view 99"});
  refused(extension + "/bufferView", -1, {"/bufferView: ", "-1"});
  refused(extension + "/bufferView", "x", {"/bufferView: "});
  refused(extension + "/bufferView", 0, {"/bufferView: ", "begin as Draco"});  // the image
  refused(extension + "/bufferView", 1, {"/bufferView: ", "12 triangles", "promises 168"});
  refused(extension + "/attributes/POSITION", 7, {"/attributes/POSITION: ", "the id 7"});
  refused(extension + "/attributes/POSITION", 2, {"/attributes/POSITION: ", "of 2 components"});
  refused(extension + "/attributes/POSITION", -2, {"/attributes/POSITION: "});
  refused(extension + "/attributes/COLOR_0", 1, {"/attributes/COLOR_0: ", "no attribute COLOR_0"});
  refused(extension + "/attributes", 5, {"/attributes: "});
  refused(extension, json::object(), {extension.c_str(), "attributes"});
  refused(primitive + "/mode", 5, {"/meshes/2/primitives/0: ", "mode 5"});
  refused(primitive + "/indices", 999, {"/meshes/2/primitives/0/indices: ", "no accessor 999"});
  refused(primitive + "/attributes/POSITION", 999, {"no accessor 999"});
  const Glb glb("ball_draco.glb");
  const std::string indices =
      "/accessors/" + glb.document[json::json_pointer(primitive + "/indices")].dump() + "/count";
  refused(indices, 3, {"168 triangles", "promises 1"});
  refused(indices, 505, {"/indices: ", "505 indices"});
  refused(indices, 2'000'000'001, {"2000000001 indices"});
  const std::string positions =
      "/accessors/" + glb.document[json::json_pointer(primitive + "/attributes/POSITION")].dump();
  refused(positions + "/count", 1'000'000'000, {"/attributes/POSITION: ", "promises 1000000000"});
  refused(positions + "/componentType", 5130, {"/componentType: "});
  refused(positions + "/type", "VEC2", {"promises", "of 2"});
}

TEST(GltfCompression, BrokenMeshoptIsRefusedAtItsPlace) {
  const auto refused = [](const std::string& pointer, const json& value,
                          std::initializer_list<const char*> parts) {
    expect_change_refused("ball_meshopt.glb", pointer, value, parts);
  };
  const Glb glb("ball_meshopt.glb");
  const auto view_with = [&](const char* mode, const char* filter) {
    for (std::size_t i = 0; i < glb.document["bufferViews"].size(); ++i) {
      const json& view = glb.document["bufferViews"][i];
      if (!view.contains("extensions")) continue;
      const json& extension = view["extensions"][kMeshopt];
      if (extension["mode"] == mode && extension.value("filter", "NONE") == filter)
        return "/bufferViews/" + std::to_string(i) + "/extensions/" + kMeshopt;
    }
    throw std::runtime_error("no such view");
  };
  const std::string triangles = view_with("TRIANGLES", "NONE");
  const std::string normals = view_with("ATTRIBUTES", "OCTAHEDRAL");
  const std::string plain = view_with("ATTRIBUTES", "NONE");
  for (const std::string& view : {triangles, normals, plain}) {
    refused(view + "/buffer", 9, {(view + "/buffer: ").c_str(), "no buffer 9"});
    refused(view + "/buffer", -1, {"/buffer: "});
    refused(view + "/byteOffset", 1 << 30, {"/byteLength: ", "outside of the buffer"});
    refused(view + "/byteLength", 0, {"/byteLength: "});
    refused(view + "/byteLength", 17, {"compressed bytes"});
    refused(view + "/byteLength", 2147483647, {"/byteLength: ", "outside of the buffer"});
    refused(view + "/byteLength", 1e12, {"/byteLength: "});
    refused(view + "/count", 0, {"/count: "});
    refused(view + "/count", 3, {"compressed bytes are not 3 elements"});
    refused(view + "/count", 2147483646, {"/count: ", "more than", "compressed bytes can hold"});
    refused(view + "/byteStride", 3, {"/byteStride: ", "3 bytes for each element"});
    refused(view + "/byteStride", 512, {"/byteStride: ", "512 bytes for each element"});
    refused(view + "/mode", "LINES", {"/mode: "});
    refused(view + "/mode", "INDICES", {kMeshopt});
    refused(view + "/filter", "GAUSS", {"/filter: "});
    refused(view, json::array(), {view.c_str()});
  }
  refused(triangles + "/count", 500, {"500 indices are no triangles"});
  refused(triangles + "/filter", "OCTAHEDRAL", {"/filter: ", "a filter of indices"});
  refused(triangles + "/mode", "ATTRIBUTES", {kMeshopt});
  refused(plain + "/filter", "OCTAHEDRAL", {});
  refused(plain + "/mode", "TRIANGLES", {kMeshopt});
}

TEST(GltfCompression, DataCutOffOrDamagedNeverPass) {
  // Each of the compressed parts ends early: the rest of it is noise or belongs to another part.
  for (const char* seed : {"ball_meshopt.glb", "ball_draco.glb", "ball_draco_sequential.glb"}) {
    const Glb whole(seed);
    for (std::size_t i = 1; i < whole.document["bufferViews"].size(); ++i) {
      const json& view = whole.document["bufferViews"][i];
      const bool is_meshopt = view.contains("extensions");
      json::json_pointer pointer = json::json_pointer("/bufferViews") / i;
      if (is_meshopt) pointer = pointer / "extensions" / kMeshopt;
      pointer /= "byteLength";
      const auto length = whole.document[pointer].get<std::size_t>();
      for (const std::size_t cut : {std::size_t{1}, length / 4, length / 2, length - 9}) {
        SCOPED_TRACE(pointer.to_string());
        Glb glb = whole;
        glb.document[pointer] = cut;
        test::expect_input_error([&] { read_glb(glb); }, {"#/"});
      }
    }
  }
}

TEST(GltfCompression, FallbackBuffersHaveNoBytes) {
  // What is not compressed may not lie in a buffer that is only a size.
  Glb glb("ball_meshopt.glb");
  for (json& view : glb.document["bufferViews"]) view.erase("extensions");
  test::expect_input_error([&] { read_glb(glb); }, {"#/meshes/", "outside of its buffer"});
  glb = Glb("ball_meshopt.glb");
  // Another file with the same bytes, which nobody needs and which is not there.
  glb.document["buffers"][1]["uri"] = "missing.bin";
  EXPECT_EQ(read_glb(glb).surfaces.size(), 3u);
}

/// A square whose positions are compressed by this library's own encoder.
struct EncodedSquare {
  GltfBuilder gltf;
  json* extension = nullptr;

  template <class T>
  EncodedSquare(const std::vector<T>& elements, std::size_t stride, const char* filter, int component_type,
                bool normalized) {
    const std::size_t count = elements.size() * sizeof(T) / stride;
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), elements.data(), count, stride));
    gltf.square();
    const int view = gltf.view(bytes);
    json& compressed = gltf.json["bufferViews"][static_cast<std::size_t>(view)];
    compressed["byteStride"] = stride;
    compressed["extensions"][kMeshopt] = {{"buffer", 0},
                                          {"byteOffset", compressed["byteOffset"]},
                                          {"byteLength", bytes.size()},
                                          {"byteStride", stride},
                                          {"count", count},
                                          {"mode", "ATTRIBUTES"},
                                          {"filter", filter}};
    // Named, for Clang 14 forgets to destroy what an assignment from braces replaces here.
    const json accessor = {{"bufferView", view},
                           {"componentType", component_type},
                           {"normalized", normalized},
                           {"count", count},
                           {"type", "VEC3"}};
    gltf.json["accessors"][0] = accessor;
  }
};

TEST(GltfCompression, ExponentsAreDecoded) {
  // Mantissa and exponent in one word: m 2^e.
  const auto coded = [](int mantissa, int exponent) {
    return static_cast<std::uint32_t>(exponent) << 24 | (static_cast<std::uint32_t>(mantissa) & 0xffffffu);
  };
  const std::vector<std::uint32_t> corners{coded(0, 0),  coded(0, 0), coded(0, 0),  //
                                           coded(3, -1), coded(0, 0), coded(0, 0),  //
                                           coded(3, -1), coded(1, 1), coded(0, 0),  //
                                           coded(0, 0),  coded(1, 1), coded(-5, -3)};
  const Surface square =
      test::read_gltf(EncodedSquare(corners, 12, "EXPONENTIAL", 5126, false).gltf).surfaces[0];
  EXPECT_EQ(square.positions[1], Vec3(1.5, 0, 0));
  EXPECT_EQ(square.positions[2], Vec3(1.5, 2, 0));
  EXPECT_EQ(square.positions[3], Vec3(0, 2, -0.625));
}

TEST(GltfCompression, OctahedraAreDecodedToUnitVectors) {
  // |x| + |y| + |z| = 1, the lower half folded out, 8 bits: x, y, one, anything.
  const std::vector<Vec3> directions{Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0.6, -0.64, 0.48),
                                     Vec3(-0.6, 0.48, -0.64)};
  std::vector<std::int8_t> coded;
  for (const Vec3& d : directions) {
    const Vec3 p = d / d.lpNorm<1>();
    Eigen::Vector2d e(p.x(), p.y());
    if (p.z() < 0) e = {std::copysign(1 - std::abs(p.y()), p.x()), std::copysign(1 - std::abs(p.x()), p.y())};
    coded.insert(coded.end(), {static_cast<std::int8_t>(std::lround(127 * e.x())),
                               static_cast<std::int8_t>(std::lround(127 * e.y())), 127, 0});
  }
  const Surface square = test::read_gltf(EncodedSquare(coded, 4, "OCTAHEDRAL", 5120, true).gltf).surfaces[0];
  for (std::size_t i = 0; i < directions.size(); ++i)
    EXPECT_LT((square.positions[i] - directions[i]).norm(), 0.015) << i;  // a step of 1/127 in each component
}

TEST(GltfCompression, IndexSequencesAreDecoded) {
  GltfBuilder gltf;
  gltf.square();
  const std::vector<unsigned int> strip{0, 1, 3, 2};
  std::vector<unsigned char> bytes(meshopt_encodeIndexSequenceBound(strip.size(), 4));
  bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), strip.data(), strip.size()));
  const int view = gltf.view(bytes);
  json& compressed = gltf.json["bufferViews"][static_cast<std::size_t>(view)];
  compressed["extensions"][kMeshopt] = {{"buffer", 0},
                                        {"byteOffset", compressed["byteOffset"]},
                                        {"byteLength", bytes.size()},
                                        {"byteStride", 2},
                                        {"count", strip.size()},
                                        {"mode", "INDICES"}};
  gltf.json["accessors"][1] = {
      {"bufferView", view}, {"componentType", 5123}, {"count", strip.size()}, {"type", "SCALAR"}};
  gltf.json["meshes"][0]["primitives"][0]["mode"] = 5;
  const Scene scene = test::read_gltf(gltf);
  EXPECT_NEAR(test::total_area(scene), 1, 1e-9);
  EXPECT_NEAR(test::area_vector(scene.surfaces[0], scene.surfaces[0].faces[1]).z(), 0.5, 1e-9);
}

TEST(GltfCompression, HiddenNodesAreLeftOutWithAllBelow) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensionsRequired"] = {"KHR_node_visibility"};
  gltf.node({{"name", "below"}, {"mesh", 0}});
  gltf.node({{"name", "hidden"},
             {"mesh", 0},
             {"children", {1}},
             {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  gltf.node({{"name", "shown"}, {"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  const Scene scene = test::read_gltf(gltf);
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(scene.surfaces[0].name, "square");
  EXPECT_EQ(scene.surfaces[1].name, "shown");
  EXPECT_THAT(scene.warnings, testing::Contains(testing::HasSubstr("1 node(s) that are not visible")));
}

TEST(GltfCompression, NewerCompressionIsRefusedWithAWayOut) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensionsRequired"] = {"KHR_meshopt_compression"};
  test::expect_gltf_refused(gltf, {"KHR_meshopt_compression", "newer", "gltf-transform copy"});
}

}  // namespace
}  // namespace reemit
