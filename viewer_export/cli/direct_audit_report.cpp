#include "viewer_export/cli/direct_audit_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
namespace {

constexpr std::size_t kNamedInText = 8;
constexpr std::size_t kNamedInJson = 1000;

const std::string& surface_of(const Solution& solution, const DirectDifference& d) {
  return solution.surface_names[solution.mesh.zone_surface(d.zone).index()];
}

std::string worst_zones_text(const DirectAudit& audit, const Solution& solution) {
  TextTable table;
  table.row({"zone of", "x [m]", "y [m]", "z [m]", "by packets", "by shadow rays", "chance"});
  for (std::size_t i = 0; i < std::min(kNamedInText, audit.different.size()); ++i) {
    const DirectDifference& d = audit.different[i];
    const Vec3 p = solution.mesh.zone_centroid(d.zone);
    table.row({"  " + surface_of(solution, d), number_text(p.x()), number_text(p.y()), number_text(p.z()),
               number_text(d.by_packets), number_text(d.by_samples), "+-" + number_text(d.limit)});
  }
  std::string text = table.text();
  if (audit.different.size() > kNamedInText)
    text += fmt::format("  and {} more, which --json lists\n", audit.different.size() - kNamedInText);
  return text;
}

}  // namespace

std::string direct_audit_text(const DirectAudit& audit, const Solution& solution) {
  TextTable table;
  table.row({"direct light [W]", "by packets", "by shadow rays", "chance", ""});
  for (std::size_t s = 0; s < audit.surfaces.size(); ++s) {
    const SurfaceDirect& d = audit.surfaces[s];
    if (d.by_packets == 0 && d.by_samples == 0) continue;
    table.row({"  " + solution.surface_names[s], number_text(d.by_packets), number_text(d.by_samples),
               "+-" + number_text(d.limit), d.differs() ? "DIFFERS" : ""});
  }
  std::string text = table.text();
  if (audit.left_out > 0)
    text += fmt::format("{} zones are left out: too small for packets, they were found by shadow rays\n",
                        audit.left_out);
  if (audit.different.empty())
    return text + fmt::format("None of {} zones differs by more than chance explains\n", audit.compared);
  text += fmt::format("{} OF {} ZONES DIFFER by more than chance explains; irradiance [W/m2]:\n",
                      audit.different.size(), audit.compared);
  text += worst_zones_text(audit, solution);
  const auto emits = [](double exitance) { return exitance > 0; };
  if (std::any_of(solution.zone_exitances.begin(), solution.zone_exitances.end(), emits))
    text +=
        "packets leave a zone of a luminous image evenly, shadow rays as the image is: what is close to one "
        "may differ; smaller zones lessen it\n";
  return text;
}

nlohmann::ordered_json direct_audit_json(const DirectAudit& audit, const Solution& solution) {
  nlohmann::ordered_json zones = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < std::min(kNamedInJson, audit.different.size()); ++i) {
    const DirectDifference& d = audit.different[i];
    const Vec3 p = solution.mesh.zone_centroid(d.zone);
    zones.push_back({{"zone", d.zone.index()},
                     {"surface", surface_of(solution, d)},
                     {"position_m", {p.x(), p.y(), p.z()}},
                     {"by_packets_W_per_m2", d.by_packets},
                     {"by_shadow_rays_W_per_m2", d.by_samples},
                     {"limit_W_per_m2", d.limit}});
  }
  nlohmann::ordered_json surfaces = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < audit.surfaces.size(); ++s) {
    const SurfaceDirect& d = audit.surfaces[s];
    surfaces.push_back({{"name", solution.surface_names[s]},
                        {"by_packets_W", d.by_packets},
                        {"by_shadow_rays_W", d.by_samples},
                        {"limit_W", d.limit},
                        {"differs", d.differs()}});
  }
  return {{"agrees", audit.agrees()},
          {"zones_compared", audit.compared},
          {"zones_left_out", audit.left_out},
          {"zones_different", audit.different.size()},
          {"surfaces", surfaces},
          {"different", zones}};
}

}  // namespace reemit::cli
