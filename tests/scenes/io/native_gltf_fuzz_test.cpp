// Damaged rooms: whatever the bytes are, a reader returns a Scene or throws an InputError, soon and with
// little memory.
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "scenes/io/ply/ply_reader.h"
#include "tests/scenes/io/gltf_building.h"
#include "tests/scenes/io/native_reading.h"

namespace reemit {
namespace {

using test::GltfBuilder;
using test::TempFolder;
using ReadFile = std::function<Scene(const std::filesystem::path&)>;

Scene read_native(const std::filesystem::path& file) {
  Scene scene = read_native_scene(file, {});
  finish_scene(scene);
  return scene;
}

Scene read_gltf_file(const std::filesystem::path& file) {
  Scene scene = read_gltf_scene(file, {});
  finish_scene(scene);
  return scene;
}

Scene scene_of_ply(const std::filesystem::path& file) {
  Scene scene;
  scene.surfaces.push_back(read_ply(file).surface);
  return scene;
}

/// One of every feature, small.
const std::string kEveryFeature = R"({
  "format": "reemit-room", "version": 1, "name": "r", "unit": "cm", "bands": "rgb",
  "materials": {"a": {"reflectance": [0.1, 0.2, 0.3], "sides": "front"}, "b": {"reflectance": {"srgb": "#804020"}, "total_flux_lm": 900},
                "c": {"luminance_cd_m2": 30, "emission_color": [1, 0.9, 0.8]}},
  "groups": {"g": [{"name": "x", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "open": ["y-"]}, "materials": {"y+": "c"}}]},
  "objects": [
    {"material": "a", "polygon": {"vertices": [[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], "holes": [[[1, 1, 0], [2, 1, 0], [2, 2, 0]]]}},
    {"group": "g", "material": "a", "array": [{"count": 3, "step": [2, 0, 0]}, {"count": 2, "rotate": {"axis": [0, 1, 0], "angle_deg": 40}}]},
    {"material": "b", "sphere": {"center": [5, 5, 5], "radius": 2, "segments": 8, "rings": 4}, "transform": [{"scale": [1, 2, 3]}, {"translate": [0, 1, 0]}]},
    {"material": "b", "cylinder": {"base": [0, 0, 0], "top": [0, 4, 0], "radius": 1, "top_radius": 0, "segments": 6}},
    {"material": "a", "disk": {"center": [0, 8, 0], "normal": [0, 1, 0], "radius": 2, "inner_radius": 1, "segments": 8}, "flip": true},
    {"material": "a", "mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 2]]}}],
  "lights": [{"type": "spot", "position": [0, 9, 0], "direction": [0, -1, 0], "outer_angle_deg": 30, "intensity_cd": 50},
             {"type": "point", "position": [0, 9, 0], "power": [1, 2, 3]}],
  "cameras": [{"name": "v", "eye": [0, 5, 20], "look_at": [0, 5, 0], "vertical_fov_deg": 50, "size": [64, 48]}]
})";

GltfBuilder small_gltf() {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int indices = gltf.view(std::vector<std::uint8_t>{2});
  const int values = gltf.view(std::vector<float>{3, 3, 0});
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  gltf.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  gltf.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 5;
  gltf.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"aspectRatio", 1.5}, {"znear", 0.1}}}}};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"intensity", 179}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}}};
  gltf.node(
      {{"camera", 0}, {"translation", {0, 1, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      gltf.floats({0, 0, 0, 0, 0, 1});
  gltf.node({{"children", {0, 1}}, {"scale", {1, -1, 1}}});
  gltf.json["scenes"] = {{{"nodes", {2}}}};
  gltf.json["scene"] = 0;
  return gltf;
}

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty "
    "float nx\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 "
    "2\n";

/// Counts how often the reader accepted or refused; anything but a Scene or an InputError fails the test.
class Outcome {
 public:
  Outcome(ReadFile read, std::string name) : read_(std::move(read)), name_(std::move(name)) {}

  void feed(const std::string& bytes, std::size_t number) {
    const auto file = folder_.write(name_, bytes);
    try {
      read_(file);
      ++accepted;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_GT(std::string(error.what()).size(), 20u);
    } catch (const std::exception& error) {
      ADD_FAILURE() << "case " << number << ": " << error.what();
    }
    // A new file each time: some file systems wait for the disk when a file is written over.
    std::filesystem::remove(file);
  }

  std::size_t accepted = 0;
  std::size_t refused = 0;

 private:
  TempFolder folder_;
  ReadFile read_;
  std::string name_;
};

/// So many damaged files of a kind; with the address sanitizer, for which each takes twenty times as long,
/// fewer.
#ifdef REEMIT_SANITIZED
constexpr std::size_t kMutations = 1000;
#else
constexpr std::size_t kMutations = 4000;
#endif

/// The largest resident size so far [MiB].
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// Changes a few bytes, or swaps, repeats or replaces a short piece: what editors, disks and networks do.
std::string mutated(std::string bytes, std::mt19937& random) {
  static const std::vector<std::string> kTokens{
      "-1",   "0",  "1e308", "-1e308", "4294967295", "99999999999999999999", "null",  "true",
      "\"\"", "[]", "{}",    "1e-320", "[[[[",       "2147483648",           "\"a\"", ","};
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const std::size_t changes = 1 + below(3);
  for (std::size_t i = 0; i < changes && bytes.size() > 8; ++i) {
    const std::size_t at = below(bytes.size());
    switch (below(5)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.erase(at, 1 + below(6));
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(12)));
        break;
      default: {
        // Replaces the next number, word or bracket by another token.
        const std::size_t start = bytes.find_first_of("0123456789\"[{tfn", at);
        if (start == std::string::npos) break;
        const std::size_t end = std::min(bytes.find_first_of(",]} \n:", start), bytes.size());
        bytes.replace(start, end - start, kTokens[below(kTokens.size())]);
      }
    }
  }
  return bytes;
}

void feed_truncations(Outcome& outcome, const std::string& whole, std::size_t step) {
  for (std::size_t length = 1; length < whole.size(); length += step)
    outcome.feed(whole.substr(0, length), length);
}

void feed_mutations(Outcome& outcome, const std::string& whole, std::size_t count) {
  std::mt19937 random(20240607);
  for (std::size_t i = 0; i < count; ++i) outcome.feed(mutated(whole, random), i);
}

/// A reader that accepts everything, or refuses everything, would make the test worthless.
void expect_both(const Outcome& outcome) {
  EXPECT_GT(outcome.accepted, 0u);
  EXPECT_GT(outcome.refused, 0u);
  constexpr long kMostMemory = 3000;  // [MiB]; with room for the sanitizers.
  EXPECT_LT(peak_memory(), kMostMemory);
}

TEST(NativeGltfFuzz, WholeRoomsAreAccepted) {
  const TempFolder folder;
  EXPECT_NO_THROW(read_native(folder.write("room.json", kEveryFeature)));
  EXPECT_NO_THROW(read_gltf_file(folder.write("room.gltf", small_gltf().text())));
  EXPECT_NO_THROW(read_gltf_file(folder.write("room.glb", small_gltf().glb())));
  EXPECT_NO_THROW(scene_of_ply(folder.write("mesh.ply", kPly)));
}

TEST(NativeGltfFuzz, NativeTruncated) {
  Outcome outcome(read_native, "room.json");
  feed_truncations(outcome, kEveryFeature, 7);
  EXPECT_EQ(outcome.accepted, 0u);
}

TEST(NativeGltfFuzz, NativeMutated) {
  Outcome outcome(read_native, "room.json");
  feed_mutations(outcome, kEveryFeature, kMutations);
  expect_both(outcome);
}

TEST(NativeGltfFuzz, GltfTruncated) {
  Outcome outcome(read_gltf_file, "room.gltf");
  feed_truncations(outcome, small_gltf().text(), 13);
  EXPECT_EQ(outcome.accepted, 0u);
}

TEST(NativeGltfFuzz, GltfMutated) {
  Outcome outcome(read_gltf_file, "room.gltf");
  feed_mutations(outcome, small_gltf().text(), kMutations);
  expect_both(outcome);
}

TEST(NativeGltfFuzz, GlbTruncated) {
  Outcome outcome(read_gltf_file, "room.glb");
  feed_truncations(outcome, small_gltf().glb(), 11);
  EXPECT_EQ(outcome.accepted, 0u);
}

TEST(NativeGltfFuzz, GlbMutated) {
  Outcome outcome(read_gltf_file, "room.glb");
  feed_mutations(outcome, small_gltf().glb(), kMutations);
  expect_both(outcome);
}

// The compressed parts alone: all lengths and the document stay as they are.
TEST(NativeGltfFuzz, CompressedBytesMutated) {
  const std::filesystem::path seeds = std::filesystem::path(REEMIT_SOURCE_DIR) / "tests" / "hard" / "seeds";
  for (const char* name : {"ball_draco.glb", "ball_draco_sequential.glb", "ball_meshopt.glb"}) {
    SCOPED_TRACE(name);
    const std::string whole = test::read_bytes(seeds / name);
    const std::size_t start = whole.find(std::string("BIN\0", 4)) + 4;
    std::mt19937 random(11);
    Outcome outcome(read_gltf_file, name);
    for (std::size_t i = 0; i < kMutations / 10; ++i) {
      std::string bytes = whole;
      for (std::size_t changes = 1 + random() % 3; changes > 0; --changes)
        bytes[start + random() % (bytes.size() - start)] = static_cast<char>(random());
      outcome.feed(bytes, i);
    }
    expect_both(outcome);
  }
}

TEST(NativeGltfFuzz, PlyMutated) {
  Outcome outcome(scene_of_ply, "mesh.ply");
  feed_mutations(outcome, kPly, kMutations);
  expect_both(outcome);
}

TEST(NativeGltfFuzz, NoiseIsRefused) {
  std::mt19937 random(7);
  for (const auto& [name, read] : std::vector<std::pair<std::string, ReadFile>>{{"room.json", read_native},
                                                                                {"room.gltf", read_gltf_file},
                                                                                {"room.glb", read_gltf_file},
                                                                                {"m.ply", scene_of_ply}}) {
    Outcome outcome(read, name);
    for (std::size_t i = 0; i < 100; ++i) {
      std::string noise(1 + random() % 400, '\0');
      for (char& c : noise) c = static_cast<char>(random());
      if (name == "room.glb") noise.replace(0, 4, "glTF");
      if (name == "m.ply") noise.insert(0, "ply\n");
      outcome.feed(noise, i);
    }
    EXPECT_EQ(outcome.accepted, 0u) << name;
  }
}

}  // namespace
}  // namespace reemit
