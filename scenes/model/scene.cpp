#include "scenes/model/scene.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "scenes/model/light_strength.h"
#include "scenes/model/scene_checks.h"
#include "scenes/model/texture_checks.h"

namespace reemit {
namespace {

bool is_grey(const Spectrum& s) {
  constexpr double kRoundOff = 1e-9;  // colour conversions leave neutral colours neutral to about 1e-15
  return s.maxCoeff() - s.minCoeff() <= kRoundOff * s.maxCoeff();
}

std::vector<bool> used_materials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const Surface& s : scene.surfaces) used[s.material.index()] = true;
  return used;
}

// Luminance-weighted mean: the one number to tell the user about a spectrum.
double luminous_mean(const Spectrum& s, const BandSet& bands) {
  const Spectrum& efficacy = bands.efficacy_lm_per_w();
  return efficacy.sum() > 0 ? (efficacy * s).sum() / efficacy.sum() : s.mean();
}

void reduce(Spectrum& s, const BandSet& bands) {
  if (s.size() > 0) s = Spectrum::Constant(1, is_grey(s) ? s[0] : luminous_mean(s, bands));
}

/// Visits the spectra of a sky; its image has others.
template <class SkyType, class Visit>
void for_each_spectrum(SkyType& sky, Visit&& visit) {
  visit(sky.irradiance);
  visit(sky.ground_reflectance);
  if (sky.sun) visit(sky.sun->irradiance);
}

bool is_grey(const Sky& sky) {
  bool grey = true;
  for_each_spectrum(sky, [&](const Spectrum& s) { grey = grey && (s.size() == 0 || is_grey(s)); });
  if (!sky.image) return grey;
  const std::vector<float>& rgb = sky.image->radiance;
  for (std::size_t i = 0; i + 2 < rgb.size() && grey; i += 3)
    grey = rgb[i] == rgb[i + 1] && rgb[i] == rgb[i + 2];
  return grey;
}

void reduce(Sky& sky, const BandSet& bands) {
  for_each_spectrum(sky, [&](Spectrum& s) { reduce(s, bands); });
  if (!sky.image) return;
  auto image = std::make_shared<SkyImage>(*sky.image);
  const std::size_t pixels = image->rows * image->columns;
  for (std::size_t i = 0; i < pixels; ++i) image->radiance[i] = image->radiance[3 * i];
  image->radiance.resize(pixels);
  sky.image = std::move(image);
}

void reduce_to_grey_if_colourless(Scene& scene, const std::vector<bool>& used) {
  if (scene.bands.kind() != BandKind::kRgb || has_coloured_textures(scene)) return;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    const NonDiffusePart& rest = m.non_diffuse;
    for (const Spectrum* s :
         {&m.reflectance, &m.back_reflectance, &m.emitted_radiance, &rest.specular_reflectance,
          &rest.diffuse_transmittance, &rest.specular_transmittance, &rest.absorption_per_m, &rest.metal_eta,
          &rest.metal_k, &m.textures.reflectance_factor, &m.textures.emission_factor})
      if (used[i] && s->size() > 0 && !is_grey(*s)) return;
  }
  for (const PunctualLight& light : scene.lights)
    if (!is_grey(strength_of(light))) return;
  if (scene.sky && !is_grey(*scene.sky)) return;

  for (Material& m : scene.materials) {
    NonDiffusePart& rest = m.non_diffuse;
    for (Spectrum* s : {&m.reflectance, &m.back_reflectance, &m.emitted_radiance, &rest.specular_reflectance,
                        &rest.diffuse_transmittance, &rest.specular_transmittance, &rest.absorption_per_m,
                        &rest.metal_eta, &rest.metal_k, &m.textures.reflectance_factor,
                        &m.textures.most_reflectance, &m.textures.emission_factor})
      reduce(*s, scene.bands);
  }
  for (PunctualLight& light : scene.lights) reduce(strength_of(light), scene.bands);
  if (scene.sky) reduce(*scene.sky, scene.bands);
  scene.bands = BandSet::grey();
  scene.notes.push_back("No surface or light has a colour: one grey band is transported.");
}

// Rays from a camera or a vertex cannot meet what has no area.
void warn_of_light_over_mirrors(Scene& scene, const std::vector<bool>& used) {
  if (scene.lights.empty()) return;
  const auto bends = [](const NonDiffusePart& part) {
    return (part.reflects_specularly() && !part.has_gloss()) ||
           (part.transmits_specularly() && part.is_solid);
  };
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!used[i] || !bends(scene.materials[i].non_diffuse)) continue;
    scene.warnings.push_back(fmt::format(
        "The room has {} light(s) without area and mirrors or bodies of glass ('{}'): zones get what comes "
        "over these, and gathered stills and vertices, but path-traced ones lack it where it falls on a "
        "surface.",
        scene.lights.size(), scene.materials[i].name));
    return;
  }
}

void warn_if_dark(Scene& scene, const std::vector<bool>& used) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (used[i] && scene.materials[i].emits()) return;
  if (!scene.lights.empty() || scene.sky) return;
  scene.warnings.push_back(
      "The room has no luminaire: no surface and no light emits, so everything stays black. A room that "
      "daylight is to come into needs a sky: solve --sky overcast:10000lx.");
}

void warn_of_units(Scene& scene) {
  constexpr double kLargest = 200, kSmallest = 0.2;  // [m]
  const Box box = bounds(scene);
  const double extent = box.size().maxCoeff();
  if (extent <= kLargest && extent >= kSmallest) return;
  scene.warnings.push_back(
      fmt::format("The room measures {:.4g} x {:.4g} x {:.4g} m, from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, "
                  "{:.4g}, {:.4g}): "
                  "unlikely for a room. Is it in other units than metres?",
                  box.size().x(), box.size().y(), box.size().z(), box.min.x(), box.min.y(), box.min.z(),
                  box.max.x(), box.max.y(), box.max.z()));
}

}  // namespace

bool Scene::bends_light() const {
  return std::any_of(surfaces.begin(), surfaces.end(),
                     [&](const Surface& s) { return material_of(s).non_diffuse.bends_light(); });
}

void finish_scene(Scene& scene) {
  check_materials(scene);
  check_geometry(scene);
  check_textures(scene);
  check_luminous_surfaces(scene);
  check_lights(scene);
  check_sky(scene);
  check_cameras(scene);
  const std::vector<bool> used = used_materials(scene);
  reduce_to_grey_if_colourless(scene, used);
  warn_of_light_over_mirrors(scene, used);
  warn_if_dark(scene, used);
  warn_of_units(scene);
}

Box bounds(const Scene& scene) {
  bool any = false;
  Box box;
  const auto add = [&](const Vec3& low, const Vec3& high) {
    box.min = any ? Vec3(box.min.cwiseMin(low)) : low;
    box.max = any ? Vec3(box.max.cwiseMax(high)) : high;
    any = true;
  };
  for (const Surface& surface : scene.surfaces) {
    for (const Face& face : surface.faces)
      for (const std::uint32_t index : face.outer) add(surface.positions[index], surface.positions[index]);
    for (const CurvedShape& shape : surface.shapes) {
      const auto [low, high] = shape_bounds(shape);
      add(low, high);
    }
  }
  return box;
}

}  // namespace reemit
