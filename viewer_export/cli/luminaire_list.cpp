#include "viewer_export/cli/luminaire_list.h"

#include <numbers>
#include <variant>

#include "solver/emit/spot_distribution.h"

namespace reemit::cli {
namespace {

using std::numbers::pi;

LuminaireRow row_of(const PointLight& light) {
  return {light.name, "point", 0, 4 * pi * light.intensity};
}

LuminaireRow row_of(const SpotLight& light) {
  return {light.name, "spot", 0, SpotDistribution(light).solid_angle() * light.intensity};
}

LuminaireRow row_of(const PhotometricLight& light) {
  return {light.name, "ies", 0, light.table->total_flux() * light.intensity_per_candela};
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
