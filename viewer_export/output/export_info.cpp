#include "viewer_export/output/export_info.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace reemit {
namespace {

InfoValue zones_value(const std::optional<ZoneBias>& zones) {
  if (!zones) return "not known";
  if (zones->bound == 0) return 0.0;
  if (!zones->certain()) return fmt::format("below {:.2g}", zones->bound);
  return zones->rms;
}

std::string text_of(const std::string& text) {
  return text;
}
std::string text_of(std::uint64_t number) {
  return std::to_string(number);
}
std::string text_of(double number) {
  return fmt::format("{:.4g}", number);
}

}  // namespace

void state_origin(const Scene& scene, const Solution& solution, ExportInfo& info) {
  info.program_version = solution.program_version;
  info.room = scene.source.empty() ? scene.name : scene.source;
  info.room_hash = solution.room_hash;
  info.seed = solution.settings.seed;
  info.stopped = to_string(solution.record.stopped);
  info.error_is_known = std::isfinite(solution.record.error);
}

double known_error(const ExportInfo& info) {
  return info.error_is_known && info.error > 0 ? info.error : std::numeric_limits<double>::infinity();
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; },
      ' ');
  return text;
}

std::vector<std::pair<std::string, InfoValue>> describe_values(const ExportInfo& info, const BandSet& bands) {
  const double error = known_error(info);
  std::vector<std::pair<std::string, InfoValue>> lines{
      {"program", "reemit " + info.program_version},
      {"room", info.room},
      {"room hash", info.room_hash},
      {"units", "lengths in m, radiance in W/(m2 sr), irradiance in W/m2, each within its band"},
      {"bands", fmt::format("{}", fmt::join(bands.names(), " "))},
      {"luminance", bands.efficacy_statement()},
      {"seed", info.seed},
      {"relative error by noise", std::isfinite(error) ? InfoValue(error) : InfoValue("not known")},
      {"relative error by zones", zones_value(info.zones)}};
  if (!info.stopped.empty()) lines.emplace_back("solve stopped", info.stopped);
  lines.insert(lines.end(), info.settings.begin(), info.settings.end());
  for (auto& [name, value] : lines) {
    name = one_line(std::move(name));
    if (auto* text = std::get_if<std::string>(&value)) *text = one_line(std::move(*text));
  }
  return lines;
}

std::vector<std::pair<std::string, std::string>> describe(const ExportInfo& info, const BandSet& bands) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const auto& [name, value] : describe_values(info, bands))
    lines.emplace_back(name, std::visit([](const auto& v) { return text_of(v); }, value));
  return lines;
}

}  // namespace reemit
