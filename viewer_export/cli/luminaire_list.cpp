#include "viewer_export/cli/luminaire_list.h"

#include <cmath>
#include <numbers>
#include <variant>

namespace reemit::cli {
namespace {

using std::numbers::pi;

LuminaireRow row_of(const PointLight& light) {
  return {light.name, "point", 0, 4 * pi * light.intensity};
}

LuminaireRow row_of(const SpotLight& light) {
  // Full intensity inside the inner cone, then falling with the square of (cos a - cos outer)/(cos inner -
  // cos outer), whose integral over the ring is a third of the ring's solid angle.
  const double inner = std::cos(light.inner_angle);
  const double outer = std::cos(light.outer_angle);
  const double solid_angle = 2 * pi * ((1 - inner) + (inner - outer) / 3);
  return {light.name, "spot", 0, solid_angle * light.intensity};
}

LuminaireRow row_of(const DirectionalLight& light) {
  return {light.name, "directional", 0, Spectrum(), light.irradiance};
}

}  // namespace

std::vector<LuminaireRow> list_luminaires(const Scene& scene, const MeshReport& report) {
  std::vector<LuminaireRow> rows;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Material& material = scene.material_of(scene.surfaces[s]);
    if (!material.emits()) continue;
    const double area = report.surfaces[s].meshed * (material.emits_both_sides ? 2 : 1);
    const Spectrum exitance = material.exitance();
    rows.push_back({scene.surfaces[s].name, "surface", area, area * exitance, exitance});
  }
  for (const PunctualLight& light : scene.lights) {
    rows.push_back(std::visit([](const auto& l) { return row_of(l); }, light));
  }
  return rows;
}

double lumens(const Spectrum& power, const BandSet& bands) {
  return (power * bands.efficacy_lm_per_w()).sum();
}

}  // namespace reemit::cli
