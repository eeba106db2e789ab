#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace reemit::test {

/// A closed box of one metre with a coloured wall and a lamp that floats under the ceiling, in the native
/// format.
inline std::string small_json_room() {
  return R"({
  "format": "reemit-room", "version": 1, "name": "small box", "bands": "rgb",
  "materials": {
    "white": {"reflectance": 0.5},
    "red": {"reflectance": [0.6, 0.1, 0.1]},
    "lamp": {"reflectance": 0, "exitance": [30, 25, 20]}
  },
  "objects": [
    {"name": "walls", "material": "white", "materials": {"x-": "red"},
     "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}},
    {"name": "lamp", "material": "lamp", "quad": {"corner": [0.4, 0.98, 0.4], "u": [0.2, 0, 0], "v": [0, 0, 0.2]}}
  ],
  "cameras": [
    {"name": "front", "eye": [0.5, 0.5, 0.05], "look_at": [0.5, 0.5, 1], "up": [0, 1, 0], "vertical_fov_deg": 70,
     "size": [12, 8]},
    {"name": "side", "eye": [0.95, 0.5, 0.5], "look_at": [0, 0.4, 0.5], "up": [0, 1, 0], "vertical_fov_deg": 70,
     "size": [12, 8]}
  ]
})";
}

/// The same kind of box as MGF, lit by its ceiling; z is up.
inline std::string small_mgf_room() {
  return "m white =\n\tsides 1\n\trd 0.5\nm lamp =\n\tsides 1\n\trd 0\n\ted 100\n"
         "v a =\n\tp 0 0 0\nv b =\n\tp 1 0 0\nv c =\n\tp 1 1 0\nv d =\n\tp 0 1 0\n"
         "v e =\n\tp 0 0 1\nv f =\n\tp 1 0 1\nv g =\n\tp 1 1 1\nv h =\n\tp 0 1 1\n"
         "m white\n"
         "o walls\nf a b c d\nf a e f b\nf b f g c\nf c g h d\nf d h e a\no\n"
         "m lamp\no ceiling\nf h g f e\no\n";
}

/// The same as OBJ; needs small_obj_materials() beside it as room.mtl.
inline std::string small_obj_room() {
  return "mtllib room.mtl\n"
         "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n"
         "o walls\nusemtl white\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
         "o ceiling\nusemtl lamp\nf 5 6 7 8\n";
}

inline std::string small_obj_materials() {
  return "newmtl white\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n";
}

/// A unit square in the xy plane as glTF, lit by nothing but itself, whose buffer is `buffer` (an URI member
/// and a comma, or nothing for GLB). Accessor 0 holds the positions, accessor 1 the indices.
inline std::string gltf_document(const std::string& buffer) {
  return R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
  "materials": [{"name": "lamp", "emissiveFactor": [1, 1, 1],
                 "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
  "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
  "buffers": [{)" +
         buffer + R"("byteLength": 60}]
})";
}

/// The square with its bytes in a data URI.
inline std::string small_gltf_room() {
  return gltf_document(
      "\"uri\": \"data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA\", ");
}

template <class T>
void append_bytes(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The square as GLB. `height` is the z coordinate of its last vertex, `index` its last vertex index.
inline std::string small_glb_room(float height = 0, std::uint16_t index = 3) {
  std::string binary;
  for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, height})
    append_bytes(binary, value);
  for (const std::uint16_t value : std::vector<std::uint16_t>{0, 1, 2, 0, 2, index})
    append_bytes(binary, value);
  std::string json = gltf_document("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string glb = "glTF";
  append_bytes(glb, std::uint32_t{2});
  append_bytes(glb, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()));
  append_bytes(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  append_bytes(glb, static_cast<std::uint32_t>(binary.size()));
  glb.append("BIN\0", 4);
  return glb + binary;
}

/// `text` with the first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument("no '" + from + "' in the text");
  return text.replace(at, from.size(), to);
}

}  // namespace reemit::test
