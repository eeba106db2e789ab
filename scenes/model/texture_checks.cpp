#include "scenes/model/texture_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/model/colour_spectra.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

std::string file_of(const Scene& scene, const Surface& surface) {
  return surface.source.empty() ? scene.source : surface.source;
}

std::string place_of(const Scene& scene, const Surface& surface, std::size_t face) {
  const std::uint32_t line = surface.faces[face].source_line;
  return fmt::format("{}{}: surface '{}', face {}", file_of(scene, surface),
                     line > 0 ? fmt::format(":{}", line) : "", surface.name, face + 1);
}

/// Coordinates beyond which single precision no longer tells texels apart count as 0. Returns whether there
/// were some.
bool check_coordinates(const Scene& scene, Surface& surface, std::size_t f) {
  const Face& face = surface.faces[f];
  const auto fail = [&](const std::string& problem, const char* advice) {
    throw InputError(place_of(scene, surface, f), problem, advice);
  };
  if (face.texture_points.size() != face.outer.size())
    fail(fmt::format("{} texture coordinates for {} vertices", face.texture_points.size(), face.outer.size()),
         "Give one pair per outer vertex, or none.");
  constexpr double kFarthest = 1e5;
  bool any_far = false;
  for (const std::uint32_t index : face.texture_points) {
    if (index >= surface.texture_points.size())
      fail(fmt::format("texture coordinate {} is out of range", index), "Refer to one that the surface has.");
    for (auto& uv : surface.texture_points[index].uv)
      for (double& x : uv)
        if (!(std::abs(x) <= kFarthest)) {
          x = 0;
          any_far = true;
        }
    for (const float share : surface.texture_points[index].colour)
      if (!(share >= 0 && share <= 1)) fail(fmt::format("the vertex colour {:g}", share), "Give 0 to 1.");
  }
  return any_far;
}

/// What the brightest texel reflects, as far as the other shares leave it. Spectra of dark colours may be as
/// bright as white in a band.
void limit_reflectance(Material& m, std::size_t bands) {
  if (!m.textures.reflectance) return;
  const bool is_spectral = m.textures.reflectance_spectra.spectra != nullptr;
  const Texel& largest = m.textures.reflectance.image->largest;
  const Spectrum others = m.share_of_light() - m.largest_reflectance();
  Spectrum most = m.textures.reflectance_factor;
  for (Eigen::Index b = 0; b < most.size(); ++b) {
    const float there = is_spectral  ? 1
                        : bands == 3 ? largest[static_cast<std::size_t>(b)]
                                     : *std::max_element(largest.begin(), largest.begin() + 3);
    most[b] = std::min(most[b] * static_cast<double>(there), std::max(0.0, 1 - others[b]));
  }
  m.textures.most_reflectance = most;
  m.reflectance = m.reflectance.min(most);
}

void warn_of_unmapped(Scene& scene, std::size_t faces, std::size_t shapes, const std::string& first) {
  if (faces + shapes == 0) return;
  scene.not_modelled["faces_without_texture_coordinates"] += faces + shapes;
  scene.warnings.push_back(
      fmt::format("{} face(s) and {} round shape(s) have a texture but no texture coordinates; they count "
                  "with the mean of the image. The first is {}",
                  faces, shapes, first));
}

}  // namespace

bool has_coloured_textures(const Scene& scene) {
  const auto is_coloured = [](const Texture& t) { return t && !t.image->is_grey; };
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& s) {
    const MaterialTextures& textures = scene.material_of(s).textures;
    if (is_coloured(textures.reflectance) || is_coloured(textures.emission)) return true;
    return s.has_vertex_colours &&
           std::any_of(s.texture_points.begin(), s.texture_points.end(), [](const TexturePoint& p) {
             return p.colour[0] != p.colour[1] || p.colour[1] != p.colour[2];
           });
  });
}

void check_textures(Scene& scene) {
  const std::size_t bands = scene.bands.count();
  for (Material& m : scene.materials) limit_reflectance(m, bands);
  std::size_t unmapped = 0;
  std::size_t shapes = 0;
  std::string first;
  std::size_t far = 0;
  std::string first_far;
  for (Surface& surface : scene.surfaces) {
    if (!scene.is_textured(surface)) continue;
    TexelSpectra& of_vertices = scene.materials[surface.material.index()].textures.reflectance_spectra;
    if (scene.bands.kind() == BandKind::kSpectral && surface.has_vertex_colours && !of_vertices.spectra)
      of_vertices.spectra = spectra_in_white(scene);
    const MaterialTextures& textures = scene.material_of(surface).textures;
    const bool has_image = textures.reflectance || textures.emission || textures.opacity;
    if (has_image && !surface.shapes.empty() && first.empty())
      first = fmt::format("{}: surface '{}'", file_of(scene, surface), surface.name);
    if (has_image) shapes += surface.shapes.size();
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      if (!surface.faces[f].texture_points.empty()) {
        if (check_coordinates(scene, surface, f) && far++ == 0) first_far = place_of(scene, surface, f);
        continue;
      }
      if (!has_image) continue;
      if (first.empty()) first = place_of(scene, surface, f);
      ++unmapped;
    }
  }
  warn_of_unmapped(scene, unmapped, shapes, first);
  if (far > 0)
    scene.warnings.push_back(
        fmt::format("{} face(s) have texture coordinates beyond 100000, which count as 0. The first is {}",
                    far, first_far));
}

std::shared_ptr<const ColourSpectra> spectra_in_white(const Scene& scene) {
  for (const Material& material : scene.materials)
    for (const TexelSpectra* known :
         {&material.textures.reflectance_spectra, &material.textures.emission_spectra})
      if (known->spectra) return known->spectra;
  return std::make_shared<const ColourSpectra>(Upsampling(scene.bands), scene.bands.count());
}

}  // namespace reemit
