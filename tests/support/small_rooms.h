#pragma once
#include <string>

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

/// `text` with the first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace reemit::test
