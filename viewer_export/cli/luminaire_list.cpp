#include "viewer_export/cli/luminaire_list.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "mesh/zones/solid_areas.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/texture/room_textures.h"
#include "solver/texture/zone_means.h"
#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
namespace {

std::vector<double> numbers_of(const Spectrum& value) {
  return {value.begin(), value.end()};
}

LuminaireRow row_of(const PunctualLight& light) {
  const auto [name, kind] =
      std::visit([](const auto& l) { return std::pair<std::string, std::string>(l.name, l.kKind); }, light);
  // Where the light comes from outside, its power is that of any beam one cares to cut out of it.
  if (is_at_infinity(light)) return {name, kind, 0, Spectrum(), strength_of(light)};
  constexpr double kAnySize = 1;
  return {name, kind, 0, light_power(light, kAnySize)};
}

/// Of the surfaces of a room, by SurfaceId.
struct SurfaceEmission {
  std::vector<double> areas;     // of one side [m2]
  std::vector<Spectrum> powers;  // [W]; size 0 where the emission does not vary over the surface
};

/// Adds up what zones emit, of surfaces on which `radiosity` (of a zone, per band [W/m2]) varies.
template <class Varies, class Radiosity>
SurfaceEmission emission_of(const MeshReport& report, const ZoneMesh& mesh, const Varies& varies,
                            const Radiosity& radiosity) {
  SurfaceEmission emission{solid_areas(report, mesh), std::vector<Spectrum>(report.surfaces.size())};
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    const SurfaceId surface = mesh.zone_surface(z);
    if (!varies(surface)) continue;
    const Spectrum power = mesh.zone_area(z) * radiosity(z);
    Spectrum& sum = emission.powers[surface.index()];
    sum = sum.size() > 0 ? Spectrum(sum + power) : power;
  }
  return emission;
}

SurfaceEmission emission_of(const Scene& scene, const MeshResult& meshed) {
  const ZoneMesh& mesh = meshed.mesh;
  const auto varies_over = [&](const Surface& surface) {
    const Material& material = scene.material_of(surface);
    return material.emits() && material.textures.emission;
  };
  const auto varies = [&](SurfaceId s) { return varies_over(scene.surfaces[s.index()]); };
  const std::size_t bands = scene.bands.count();
  ZoneTextureMeans means;
  // To take them is to look at every texel.
  if (std::any_of(scene.surfaces.begin(), scene.surfaces.end(), varies_over))
    means = zone_texture_means(RoomTextures(scene, mesh), mesh, bands);
  return emission_of(meshed.report, mesh, varies, [&](ZoneId z) {
    Material material = scene.material_of(scene.surfaces[mesh.zone_surface(z).index()]);
    const bool emits = mesh.zone_shows_front(z) || material.emits_both_sides;
    material.emitted_radiance =
        (emits ? 1 : 0) * Spectrum::Map(&means.radiance[z.index() * bands], static_cast<Eigen::Index>(bands));
    return material.exitance();
  });
}

SurfaceEmission emission_of(const Solution& solution) {
  const auto radiosity = [&](ZoneId z) {
    Spectrum emitted(static_cast<Eigen::Index>(solution.bands.count()));
    for (std::size_t b = 0; b < solution.bands.count(); ++b)
      emitted[static_cast<Eigen::Index>(b)] = solution.emitted_radiosity(z, b);
    return emitted;
  };
  // Solutions keep no textures, but what zones emit where there are any.
  const bool has_textures = !solution.zone_exitances.empty();
  return emission_of(
      solution.mesh_report, solution.mesh, [&](SurfaceId) { return has_textures; }, radiosity);
}

void add_surface(const std::string& name, const Material& material, const SurfaceEmission& emission,
                 std::size_t surface, std::vector<LuminaireRow>& rows) {
  if (!material.emits()) return;
  const double area = emission.areas[surface] * (material.emits_both_sides ? 2 : 1);
  const Spectrum& power = emission.powers[surface];
  if (power.size() > 0)
    rows.push_back({name, "surface", area, power, area > 0 ? Spectrum(power / area) : Spectrum(0 * power)});
  else
    rows.push_back({name, "surface", area, area * material.exitance(), material.exitance()});
}

/// As other light from outside, with what falls on a horizontal plane there, and across the beam of the sun.
void add_sky(const Sky& sky, const BandSet& bands, std::vector<LuminaireRow>& rows) {
  if (sky.kind != SkyKind::kNone)
    rows.push_back({"sky", sky.description, 0, Spectrum(), horizontal_sky_irradiance(sky, bands)});
  if (sky.sun_shines()) rows.push_back({"sun", "sun", 0, Spectrum(), sky.sun->irradiance});
}

void add_lights(const Scene& scene, std::vector<LuminaireRow>& rows) {
  for (const PunctualLight& light : scene.lights) rows.push_back(row_of(light));
  if (scene.sky) add_sky(*scene.sky, scene.bands, rows);
}

Spectrum total_power(const std::vector<LuminaireRow>& rows, const BandSet& bands) {
  Spectrum total = Spectrum::Zero(static_cast<Eigen::Index>(bands.count()));
  for (const LuminaireRow& luminaire : rows)
    if (luminaire.power.size() > 0) total += luminaire.power;
  return total;
}

}  // namespace

std::vector<LuminaireRow> list_luminaires(const Scene& scene, const MeshResult& meshed) {
  const SurfaceEmission emission = emission_of(scene, meshed);
  std::vector<LuminaireRow> rows;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    add_surface(scene.surfaces[s].name, scene.material_of(scene.surfaces[s]), emission, s, rows);
  add_lights(scene, rows);
  return rows;
}

std::vector<LuminaireRow> list_luminaires(const Scene& scene, const Solution& solution) {
  std::vector<LuminaireRow> rows = list_luminous_surfaces(solution);
  add_lights(scene, rows);
  return rows;
}

std::vector<LuminaireRow> list_luminous_surfaces(const Solution& solution) {
  const SurfaceEmission emission = emission_of(solution);
  std::vector<LuminaireRow> rows;
  for (std::size_t s = 0; s < solution.surface_names.size(); ++s)
    add_surface(solution.surface_names[s], solution.materials[solution.surface_materials[s].index()],
                emission, s, rows);
  return rows;
}

std::string luminaires_text(const std::vector<LuminaireRow>& rows, const BandSet& bands) {
  if (rows.empty()) return "Luminaires: none\n";
  TextTable table;
  std::vector<std::string> head{"luminaire", "kind", "area [m2]"};
  add_band_heads(head, "W", bands);
  head.emplace_back("flux [lm]");
  table.row(std::move(head));
  for (std::size_t l = 0; l < std::min(kMostRows, rows.size()); ++l) {
    const LuminaireRow& luminaire = rows[l];
    std::vector<std::string> cells{"  " + luminaire.name, luminaire.kind,
                                   luminaire.area > 0 ? number_text(luminaire.area) : "-"};
    if (luminaire.power.size() > 0) {
      add_band_cells(cells, luminaire.power);
      cells.push_back(number_text(lumens(luminaire.power, bands)));
    }
    table.row(std::move(cells));
  }
  const Spectrum total = total_power(rows, bands);
  std::vector<std::string> cells{"  total", "", ""};
  add_band_cells(cells, total);
  cells.push_back(number_text(lumens(total, bands)));
  table.row(std::move(cells));
  return "Luminaires: power [W] per band\n" + table.text() + rest_text(rows.size(), "luminaires");
}

void add_luminaires(nlohmann::ordered_json& json, const std::vector<LuminaireRow>& rows,
                    const BandSet& bands) {
  json["luminaires"] = nlohmann::ordered_json::array();
  for (const LuminaireRow& luminaire : rows) {
    nlohmann::ordered_json& row = json["luminaires"].emplace_back();
    row = {{"name", luminaire.name}, {"kind", luminaire.kind}};
    if (luminaire.area > 0) row["area_m2"] = luminaire.area;
    if (luminaire.power.size() > 0) {
      row["power_W"] = numbers_of(luminaire.power);
      row["flux_lm"] = lumens(luminaire.power, bands);
    }
    if (luminaire.power_per_area.size() > 0)
      row["power_per_area_W_m2"] = numbers_of(luminaire.power_per_area);
  }
  const Spectrum total = total_power(rows, bands);
  json["total_power_W"] = numbers_of(total);
  json["total_flux_lm"] = lumens(total, bands);
}

double lumens(const Spectrum& power, const BandSet& bands) {
  return (power * bands.efficacy_lm_per_w()).sum();
}

}  // namespace reemit::cli
