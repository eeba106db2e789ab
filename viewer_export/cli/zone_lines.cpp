#include "viewer_export/cli/zone_lines.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "solver/solution/zone_summary.h"
#include "viewer_export/cli/text_table.h"

namespace reemit::cli {

std::string shared_zones_text(const ZoneMesh& mesh, int head_width, std::optional<double> sealed_light) {
  const ZoneSummary zones = summarise_zones(mesh);
  std::string text;
  if (zones.shared > 0)
    text += fmt::format("{:{}}{} small sides of triangles have {} of the zones\n", "shared", head_width,
                        zones.shared_sides, zones.shared);
  if (zones.sealed > 0)
    text += fmt::format("{:{}}{:.4g} m2 that no light should reach have {} of the zones{}\n", "sealed",
                        head_width, zones.sealed_area, zones.sealed,
                        sealed_light ? fmt::format("; they got {} of it", percent_text(*sealed_light)) : "");
  return text;
}

void add_shared_zones(nlohmann::ordered_json& json, const ZoneMesh& mesh,
                      std::optional<double> sealed_light) {
  const ZoneSummary zones = summarise_zones(mesh);
  json["shared_zones"] = zones.shared;
  json["sides_in_shared_zones"] = zones.shared_sides;
  json["sealed_zones"] = zones.sealed;
  json["sealed_area_m2"] = zones.sealed_area;
  if (sealed_light) json["sealed_light_share"] = *sealed_light;
}

}  // namespace reemit::cli
