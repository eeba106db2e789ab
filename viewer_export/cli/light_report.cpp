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

/// Columns about a surface or material: in lux, or in watts where no eye sees the bands.
class LightColumns {
 public:
  LightColumns(const BandSet& bands, double percent_per_lux)
      : names_(bands.names()),
        percent_(percent_per_lux),
        is_visible_((bands.efficacy_lm_per_w() > 0).any()) {}

  const char* what_arrives() const { return is_visible_ ? "illuminance" : "irradiance"; }
  bool lack_bands() const { return !is_visible_ && names_.size() > kMostBands; }

  std::vector<std::string> head(const std::string& of) const {
    std::vector<std::string> cells{of, "area [m2]"};
    const auto add = [&cells](const std::string& quantity) {
      cells.push_back(quantity);
      cells.emplace_back("+-");
    };
    if (is_visible_)
      for (const char* quantity : {"E [lx]", "M [lm/m2]", "received [lm]"}) add(quantity);
    else
      for (std::size_t b = 0; b < std::min(kMostBands, names_.size()); ++b)
        for (const char quantity : {'E', 'M'}) add(fmt::format("{} {} [W/m2]", quantity, names_[b]));
    if (percent_ > 0) add("DF [%]");
    return cells;
  }

  void add(std::vector<std::string>& cells, const MeanLight& light) const {
    cells.push_back(number_text(light.area));
    std::vector<Estimate> values;
    if (is_visible_)
      values = {light.illuminance, light.luminous_exitance, times(light.area, light.illuminance)};
    else
      for (std::size_t b = 0; b < std::min(kMostBands, names_.size()); ++b)
        values.insert(values.end(), {light.irradiance[b], light.exitance[b]});
    if (percent_ > 0) values.push_back(times(percent_, light.illuminance));
    // A side that no ray found lit may still get a little.
    const bool unlit = std::all_of(light.irradiance.begin(), light.irradiance.end(),
                                   [](const Estimate& e) { return e.mean == 0; });
    for (const Estimate& value : values) {
      const auto [mean, error] = estimate_texts(value.mean, value.stderr_of_mean);
      cells.push_back(mean);
      cells.push_back(unlit && value.mean == 0 ? "none met" : error);
    }
  }

 private:
  static constexpr std::size_t kMostBands = 4;

  std::vector<std::string> names_;
  double percent_;
  bool is_visible_;
};

std::string sides_text(const Solution& solution, const RoomLight& room, const LightColumns& columns) {
  std::vector<const SideLight*> shown;
  for (const SideLight& side : room.sides)
    if (side.counts) shown.push_back(&side);
  TextTable table;
  table.row(columns.head("surface"));
  for (std::size_t i = 0; i < std::min(kMostRows, shown.size()); ++i) {
    const SideLight& side = *shown[i];
    std::vector<std::string> cells{"  " + solution.surface_names[side.surface.index()] +
                                   (side.front ? "" : " (back)")};
    columns.add(cells, side.light);
    table.row(std::move(cells));
  }
  return table.text() + rest_text(shown.size(), "surfaces");
}

std::string materials_text(const Solution& solution, const RoomLight& room, const LightColumns& columns) {
  TextTable table;
  table.row(columns.head("material"));
  std::size_t used = 0;
  for (std::size_t m = 0; m < room.materials.size(); ++m) {
    if (!(room.materials[m].area > 0) || ++used > kMostRows) continue;
    std::vector<std::string> cells{"  " + solution.materials[m].name};
    columns.add(cells, room.materials[m]);
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
  const LightColumns columns(solution.bands, percent);
  std::string text =
      fmt::format(
          "Light: area means of {} E and of exitance M, reflected and emitted; +- one standard error\n",
          columns.what_arrives()) +
      sides_text(solution, room, columns) + '\n' + materials_text(solution, room, columns) + '\n' +
      luminaires_text(luminaires, solution.bands);
  if (columns.lack_bands()) text += "\nOf the bands, the first four are in these tables; --json has all\n";
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
