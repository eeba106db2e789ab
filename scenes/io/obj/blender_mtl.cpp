#include "scenes/io/obj/blender_mtl.h"

#include <algorithm>
#include <cmath>

#include <tiny_obj_loader.h>

namespace reemit {

bool is_written_by_blender(std::string_view mtl) {
  const std::string_view first = mtl.substr(0, mtl.find('\n'));
  return first.starts_with("# Blender ") && first.find("MTL File") != std::string_view::npos;
}

void read_as_written_by_blender(tinyobj::material_t& material) {
  using Real = tinyobj::real_t;
  constexpr int kMetal = 3;
  constexpr int kHighlight = 2;
  constexpr Real kLargest = 1000;  // Ns of what is not rough
  constexpr Real kSharpest = 1e6F;
  std::fill_n(material.specular, 3, Real(0));
  if (material.illum != kMetal || !material.diffuse_texname.empty()) return;
  const Real smooth = std::sqrt(std::clamp(material.shininess / kLargest, Real(0), Real(1)));
  const Real alpha = (1 - smooth) * (1 - smooth);
  material.shininess = std::min(kSharpest, 2 / (alpha * alpha) - 2);
  for (int c = 0; c < 3; ++c) {
    const Real metal = std::min(material.ambient[c], Real(1));
    material.specular[c] = metal * material.diffuse[c];
    material.diffuse[c] *= 1 - metal;
  }
  material.illum = kHighlight;
}

}  // namespace reemit
