#include "viewer_export/cli/error_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
std::string zones_text(const std::optional<ZoneBias>& zones) {
  if (!zones) return "not known";
  if (zones->bound == 0) return "none";
  return zones->certain() ? rough_percent_text(zones->rms) : "below " + rough_percent_text(zones->bound);
}

void add_zones(nlohmann::ordered_json& json, const std::optional<ZoneBias>& zones) {
  json["zone_error"] = zones ? nlohmann::ordered_json(zones->rms) : nlohmann::ordered_json(nullptr);
  json["zone_error_bound"] = zones ? nlohmann::ordered_json(zones->bound) : nlohmann::ordered_json(nullptr);
}

std::string missed_by_zones(const std::string& what, double target, const std::optional<ZoneBias>& zones) {
  if (!(target > 0) || !zones || !zones->certain() || zones->rms <= target) return "";
  return fmt::format(
      "the zones keep {} from an error of {}: they are too large and put it off by about {}, whatever its "
      "noise; solve with more --zones",
      what, percent_text(target), rough_percent_text(zones->rms));
}

}  // namespace reemit::cli
