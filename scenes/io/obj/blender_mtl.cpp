#include "scenes/io/obj/blender_mtl.h"

#include <algorithm>
#include <cmath>

#include <tiny_obj_loader.h>

namespace reemit {

bool is_written_by_blender(std::string_view mtl) {
  const std::string_view first = mtl.substr(0, mtl.find('\n'));
  return first.starts_with("# Blender ") && first.find("MTL File") != std::string_view::npos;
}

std::optional<double> read_as_written_by_blender(tinyobj::material_t& material) {
  using Real = tinyobj::real_t;
  constexpr int kMetal = 3;
  constexpr int kHighlight = 2;
  constexpr double kLargest = 1000;  // Ns of what is not rough
  std::fill_n(material.specular, 3, Real(0));
  if (material.illum != kMetal || !material.diffuse_texname.empty()) return std::nullopt;
  for (int c = 0; c < 3; ++c) {
    const Real metal = std::min(material.ambient[c], Real(1));
    material.specular[c] = metal * material.diffuse[c];
    material.diffuse[c] *= 1 - metal;
  }
  material.illum = kHighlight;
  const double rough =
      1 - std::sqrt(std::clamp(static_cast<double>(material.shininess) / kLargest, 0.0, 1.0));
  return rough * rough;
}

}  // namespace reemit
