#include "viewer_export/formats/export_info.h"

#include <algorithm>

#include <fmt/format.h>

namespace reemit {
namespace {

std::string zones_text(const std::optional<ZoneBias>& zones) {
  if (!zones) return "not known";
  if (zones->bound == 0) return "0";
  return zones->certain() ? fmt::format("{:.2g}", zones->rms) : fmt::format("below {:.2g}", zones->bound);
}

}  // namespace

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      ' ');
  return text;
}

std::vector<std::pair<std::string, std::string>> describe(const ExportInfo& info, const BandSet& bands) {
  std::vector<std::pair<std::string, std::string>> lines{
      {"program", "reemit " + info.program_version},
      {"room", info.room},
      {"room hash", info.room_hash},
      {"units", "lengths in m, radiance in W/(m2 sr), irradiance in W/m2, each within its band"},
      {"bands", fmt::format("{}", fmt::join(bands.names(), " "))},
      {"luminance", bands.efficacy_statement()},
      {"seed", std::to_string(info.seed)},
      {"relative error by noise", info.error > 0 ? fmt::format("{:.4g}", info.error) : "not known"},
      {"relative error by zones", zones_text(info.zones)}};
  lines.insert(lines.end(), info.settings.begin(), info.settings.end());
  for (auto& [name, value] : lines) {
    name = one_line(std::move(name));
    value = one_line(std::move(value));
  }
  return lines;
}

}  // namespace reemit
