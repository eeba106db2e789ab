#include "viewer_export/cli/light_report.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "solver/solution/mean_light.h"
#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;

Estimate times(double factor, const Estimate& value) {
  return {factor * value.mean, factor * value.stderr_of_mean};
}

/// In per cent of what the sky, not the sun, sends onto a horizontal plane outside; 0: there is none.
double percent_per_lux(const std::optional<LightOutside>& outside) {
  return outside && outside->sky_lx > 0 ? 100 / outside->sky_lx : 0;
}

void add_head(std::vector<std::string>& cells, double percent) {
  for (const char* quantity : {"area [m2]", "E [lx]", "+-", "M [lm/m2]", "+-", "received [lm]", "+-"})
    cells.emplace_back(quantity);
  if (!(percent > 0)) return;
  cells.emplace_back("DF [%]");
  cells.emplace_back("+-");
}

void add_cells(std::vector<std::string>& cells, const MeanLight& light, double percent) {
  cells.push_back(number_text(light.area));
  std::vector<Estimate> values{light.illuminance, light.luminous_exitance,
                               times(light.area, light.illuminance)};
  if (percent > 0) values.push_back(times(percent, light.illuminance));
  // A side that no ray found lit may still get a little.
  const bool unlit = std::all_of(light.irradiance.begin(), light.irradiance.end(),
                                 [](const Estimate& e) { return e.mean == 0; });
  for (const Estimate& value : values) {
    const auto [mean, error] = estimate_texts(value.mean, value.stderr_of_mean);
    cells.push_back(mean);
    cells.push_back(unlit && value.mean == 0 ? "none met" : error);
  }
}

std::string sides_text(const Solution& solution, const RoomLight& room, double percent) {
  std::vector<const SideLight*> shown;
  for (const SideLight& side : room.sides)
    if (side.counts) shown.push_back(&side);
  TextTable table;
  std::vector<std::string> head{"surface"};
  add_head(head, percent);
  table.row(std::move(head));
  for (std::size_t i = 0; i < std::min(kMostRows, shown.size()); ++i) {
    const SideLight& side = *shown[i];
    std::vector<std::string> cells{"  " + solution.surface_names[side.surface.index()] +
                                   (side.front ? "" : " (back)")};
    add_cells(cells, side.light, percent);
    table.row(std::move(cells));
  }
  return table.text() + rest_text(shown.size(), "surfaces");
}

std::string materials_text(const Solution& solution, const RoomLight& room, double percent) {
  TextTable table;
  std::vector<std::string> head{"material"};
  add_head(head, percent);
  table.row(std::move(head));
  std::size_t used = 0;
  for (std::size_t m = 0; m < room.materials.size(); ++m) {
    if (!(room.materials[m].area > 0) || ++used > kMostRows) continue;
    std::vector<std::string> cells{"  " + solution.materials[m].name};
    add_cells(cells, room.materials[m], percent);
    table.row(std::move(cells));
  }
  return table.text() + rest_text(used, "materials");
}

Json means(const std::vector<Estimate>& bands) {
  Json values = Json::array();
  for (const Estimate& band : bands) values.push_back(band.mean);
  return values;
}

Json errors(const std::vector<Estimate>& bands) {
  Json values = Json::array();
  for (const Estimate& band : bands) values.push_back(band.stderr_of_mean);
  return values;
}

void add_light(Json& json, const MeanLight& light, double percent) {
  const auto add = [&json](const char* name, const char* unit, const Estimate& value) {
    json[fmt::format("{}_{}", name, unit)] = value.mean;
    json[fmt::format("{}_stderr_{}", name, unit)] = value.stderr_of_mean;
  };
  json["area_m2"] = light.area;
  add("illuminance", "lx", light.illuminance);
  if (percent > 0) add("daylight_factor", "percent", times(percent, light.illuminance));
  add("exitance", "lm_m2", light.luminous_exitance);
  add("received_flux", "lm", times(light.area, light.illuminance));
  add("leaving_flux", "lm", times(light.area, light.luminous_exitance));
  json["irradiance_W_m2"] = means(light.irradiance);
  json["irradiance_stderr_W_m2"] = errors(light.irradiance);
  json["exitance_W_m2"] = means(light.exitance);
  json["exitance_stderr_W_m2"] = errors(light.exitance);
}

}  // namespace

std::string light_text(const Solution& solution, const std::vector<LuminaireRow>& luminaires,
                       const std::optional<LightOutside>& outside) {
  const RoomLight room = mean_light(solution);
  const double percent = percent_per_lux(outside);
  std::string text =
      "Light: area means of illuminance E and of exitance M, reflected and emitted; +- one standard error\n" +
      sides_text(solution, room, percent) + '\n' + materials_text(solution, room, percent) + '\n' +
      luminaires_text(luminaires, solution.bands);
  if (outside)
    text += fmt::format("\nOutside, on a horizontal plane: {:.4g} lx of the sky{}\n", outside->sky_lx,
                        outside->sun_lx > 0 ? fmt::format(" and {:.4g} lx of the sun", outside->sun_lx) : "");
  if (percent > 0) text += "DF: illuminance over that of the sky outside\n";
  return text;
}

void add_light(Json& json, const Solution& solution, const std::vector<LuminaireRow>& luminaires,
               const std::optional<LightOutside>& outside) {
  const RoomLight room = mean_light(solution);
  const double percent = percent_per_lux(outside);
  if (outside) {
    json["outside_sky_illuminance_lx"] = outside->sky_lx;
    json["outside_sun_illuminance_lx"] = outside->sun_lx;
  }
  json["stderr_degrees_of_freedom"] = room.degrees_of_freedom;
  json["surfaces"] = Json::array();
  for (const SideLight& side : room.sides) {
    const std::size_t s = side.surface.index();
    Json& row = json["surfaces"].emplace_back();
    row = {{"name", solution.surface_names[s]},
           {"side", side.front ? "front" : "back"},
           {"material", solution.materials[solution.surface_materials[s].index()].name},
           {"counts", side.counts}};
    add_light(row, side.light, percent);
  }
  json["materials"] = Json::array();
  for (std::size_t m = 0; m < room.materials.size(); ++m) {
    Json& row = json["materials"].emplace_back();
    row = {{"name", solution.materials[m].name}};
    add_light(row, room.materials[m], percent);
  }
  add_luminaires(json, luminaires, solution.bands);
}

}  // namespace reemit::cli
