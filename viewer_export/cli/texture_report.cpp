#include "viewer_export/cli/texture_report.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace reemit::cli {
namespace {

/// The images of the materials that surfaces have, by their address, in no order that matters but the same
/// for all of one room: that of their sources.
std::map<std::string, const TextureImage*> images_of(const Scene& scene) {
  std::map<std::string, const TextureImage*> images;
  for (const Surface& surface : scene.surfaces) {
    const MaterialTextures& textures = scene.material_of(surface).textures;
    for (const Texture* t : {&textures.reflectance, &textures.emission, &textures.opacity})
      if (*t) images[fmt::format("{} {}", t->image->source, t->image->hash)] = t->image.get();
  }
  return images;
}

struct Uses {
  std::size_t reflectance = 0, emission = 0, cut_outs = 0, coloured = 0;
};

Uses uses_of(const Scene& scene) {
  Uses uses;
  for (const Surface& surface : scene.surfaces) {
    const MaterialTextures& textures = scene.material_of(surface).textures;
    uses.reflectance += textures.reflectance ? 1 : 0;
    uses.emission += textures.emission ? 1 : 0;
    uses.cut_outs += textures.is_cut_out() ? 1 : 0;
    uses.coloured += surface.has_vertex_colours ? 1 : 0;
  }
  return uses;
}

}  // namespace

std::string textures_text(const Scene& scene) {
  const auto images = images_of(scene);
  const Uses uses = uses_of(scene);
  if (images.empty() && uses.cut_outs + uses.coloured == 0) return "";
  std::size_t bytes = 0;
  double texels = 0;
  for (const auto& [name, image] : images) {
    bytes += image->memory();
    texels += 1.0 * image->width * image->height;
  }
  return fmt::format(
      "{} image(s), {:.3g} million texels, {:.3g} MB; surfaces with textures of reflectance {}, of emission "
      "{}, "
      "cut-outs {}, with vertex colours {}",
      images.size(), texels * 1e-6, static_cast<double>(bytes) * 1e-6, uses.reflectance, uses.emission,
      uses.cut_outs, uses.coloured);
}

nlohmann::ordered_json textures_json(const Scene& scene) {
  nlohmann::ordered_json json;
  json["images"] = nlohmann::ordered_json::array();
  std::size_t bytes = 0;
  for (const auto& [name, image] : images_of(scene)) {
    bytes += image->memory();
    json["images"].push_back({{"source", image->source},
                              {"width", image->width},
                              {"height", image->height},
                              {"width_read", image->read_width},
                              {"height_read", image->read_height},
                              {"memory_bytes", image->memory()}});
  }
  json["memory_bytes"] = bytes;
  const Uses uses = uses_of(scene);
  json["surfaces"] = {{"reflectance", uses.reflectance},
                      {"emission", uses.emission},
                      {"cut_outs", uses.cut_outs},
                      {"vertex_colours", uses.coloured}};
  return json;
}

}  // namespace reemit::cli
