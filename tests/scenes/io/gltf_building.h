#pragma once
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/io/gltf/gltf_reader.h"
#include "tests/scenes/io/expect_input_error.h"
#include "tests/support/temp_folder.h"

namespace reemit::test {

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

/// A glTF file under construction: one buffer, which takes one accessor after the other.
class GltfBuilder {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},        {"bufferViews", nlohmann::json::array()},
                         {"accessors", nlohmann::json::array()}, {"materials", nlohmann::json::array()},
                         {"meshes", nlohmann::json::array()},    {"nodes", nlohmann::json::array()}};

  /// Returns the number of the buffer view.
  template <class T>
  int view(const std::vector<T>& values) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    const std::size_t offset = bytes_.size();
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  template <class T>
  int accessor(const std::vector<T>& values, int component_type, const char* type, std::size_t components) {
    json["accessors"].push_back({{"bufferView", view(values)},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& values) { return accessor(values, 5126, "VEC3", 3); }
  int bytes(const std::vector<std::uint8_t>& values) { return accessor(values, 5121, "SCALAR", 1); }
  int shorts(const std::vector<std::uint16_t>& values) { return accessor(values, 5123, "SCALAR", 1); }
  int ints(const std::vector<std::uint32_t>& values) { return accessor(values, 5125, "SCALAR", 1); }

  int material(const nlohmann::json& fields) { return append("materials", fields); }
  int node(const nlohmann::json& fields) { return append("nodes", fields); }
  int mesh(const nlohmann::json& primitive) { return append("meshes", {{"primitives", {primitive}}}); }

  /// Material 0, mesh 0 and node 0: a unit square in the plane z = 0 that looks to +z.
  GltfBuilder& square() {
    material({{"name", "grey"},
              {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}});
    const int positions = floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    mesh({{"attributes", {{"POSITION", positions}}},
          {"indices", shorts({0, 1, 2, 0, 2, 3})},
          {"material", 0}});
    node({{"name", "square"}, {"mesh", 0}});
    return *this;
  }

  /// With the buffer as a data URI.
  std::string text() const {
    nlohmann::json file = json;
    file["buffers"] = {
        {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
    return file.dump();
  }

  std::string glb() const {
    nlohmann::json file = json;
    std::string binary = bytes_;
    while (binary.size() % 4 != 0) binary += '\0';
    file["buffers"] = {{{"byteLength", bytes_.size()}}};
    std::string text = file.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string bytes =
        "glTF" + word(2) + word(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
    bytes += word(static_cast<std::uint32_t>(text.size())) + "JSON" + text;
    return bytes + word(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
  }

  const std::string& buffer() const { return bytes_; }

 private:
  static std::string word(std::uint32_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
    return bytes;
  }

  int append(const char* list, const nlohmann::json& fields) {
    json[list].push_back(fields);
    return static_cast<int>(json[list].size()) - 1;
  }

  std::string bytes_;
};

inline Scene read_gltf(const GltfBuilder& gltf, const ReadOptions& options = {}) {
  const TempFolder folder;
  return read_gltf_scene(folder.write("room.gltf", gltf.text()), options);
}

inline void expect_gltf_refused(const GltfBuilder& gltf, std::initializer_list<const char*> parts) {
  expect_input_error([&] { read_gltf(gltf); }, parts);
}

}  // namespace reemit::test
