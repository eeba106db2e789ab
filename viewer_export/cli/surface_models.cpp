#include "viewer_export/cli/surface_models.h"

#include <algorithm>
#include <atomic>
#include <map>

#include "solver/progressive_solver.h"

namespace reemit::cli {
namespace {

/// By surface, the power that arrives at both of its sides, all bands together.
std::vector<double> arriving_power(const Scene& scene, const MeshResult& meshed) {
  SolverSettings settings;
  settings.packets = settings.batch_packets = 1U << 16;
  settings.gather_small_zones = false;
  const std::atomic<bool> interrupt{false};
  const Solution solution = solve_zones(scene, meshed, settings, nullptr, interrupt);
  std::vector<double> power(scene.surfaces.size(), 0.0);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    for (std::size_t b = 0; b < scene.bands.count(); ++b)
      power[solution.mesh.zone_surface(ZoneId(z)).index()] +=
          solution.mesh.zone_area(ZoneId(z)) * solution.irradiance(ZoneId(z), b).mean;
  return power;
}

}  // namespace

std::vector<std::string> models_of(const Material& material) {
  const NonDiffusePart& part = material.non_diffuse;
  const bool crosses = part.transmits_specularly();
  const bool is_glass = crosses && part.angle_law == AngleLaw::kDielectric;
  std::vector<std::string> models;
  if (is_glass)
    models.emplace_back(part.is_solid ? "solid glass" : "glass pane");
  else if (part.has_glossy_transmission())
    models.emplace_back("hazy sheet");
  else if (crosses)
    models.emplace_back("clear sheet");
  if (is_glass && (part.has_gloss() || part.has_glossy_transmission())) models.back().insert(0, "rough ");
  if (part.reflects_specularly() && !is_glass) {
    const bool is_metal =
        part.angle_law == AngleLaw::kConductor ||
        (part.angle_law == AngleLaw::kSchlick && !NonDiffusePart::is_given(material.reflectance));
    if (part.has_gloss())
      models.emplace_back(is_metal ? "rough metal" : "gloss");
    else
      models.emplace_back(is_metal ? "metal" : "mirror");
  }
  if (part.transmits_diffusely()) models.emplace_back("diffuse transmission");
  return models;
}

std::vector<ModelShare> model_shares(const Scene& scene, const MeshResult& meshed) {
  std::vector<std::vector<std::string>> models;
  for (const Surface& surface : scene.surfaces) models.push_back(models_of(scene.material_of(surface)));
  if (std::all_of(models.begin(), models.end(), [](const auto& m) { return m.empty(); })) return {};
  const std::vector<double> power = arriving_power(scene, meshed);
  std::map<std::string, ModelShare> of_model;
  ModelShare all;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const double area = meshed.report.surfaces[s].input;
    all.area += area;
    all.power += power[s];
    for (const std::string& model : models[s]) {
      of_model[model].area += area;
      of_model[model].power += power[s];
    }
  }
  std::vector<ModelShare> shares;
  for (const auto& [model, sum] : of_model)
    shares.push_back(
        {model, all.area > 0 ? sum.area / all.area : 0, all.power > 0 ? sum.power / all.power : 0});
  std::stable_sort(shares.begin(), shares.end(),
                   [](const ModelShare& a, const ModelShare& b) { return a.area > b.area; });
  return shares;
}

}  // namespace reemit::cli
