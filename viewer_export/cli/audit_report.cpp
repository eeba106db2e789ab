#include "viewer_export/cli/audit_report.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;
using SurfaceQuanta = std::vector<RunQuanta> BandAudit::*;

constexpr std::array<const char*, 6> kDirections{"+x", "-x", "+y", "-y", "+z", "-z"};

double watts_of_surface(const EnergyAudit& audit, SurfaceQuanta quanta, std::size_t surface) {
  return std::transform_reduce(
      audit.bands.begin(), audit.bands.end(), 0.0, std::plus<>(),
      [&](const BandAudit& band) { return audit.watts(band, (band.*quanta)[surface]); });
}

/// Surfaces by falling power over all bands; equal ones in the order of the room.
std::vector<std::size_t> by_power(const EnergyAudit& audit, SurfaceQuanta quanta, std::size_t surface_count) {
  std::vector<double> watts(surface_count);
  for (std::size_t s = 0; s < surface_count; ++s) watts[s] = watts_of_surface(audit, quanta, s);
  std::vector<std::size_t> order(surface_count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return watts[a] > watts[b]; });
  return order;
}

class AuditTable {
 public:
  explicit AuditTable(const EnergyAudit& audit) : audit_(audit) {
    std::vector<std::string> head{"power [W]"};
    for (const BandAudit& band : audit.bands) head.push_back(band.band);
    head.emplace_back("share");
    table_.row(std::move(head));
    for (const BandAudit& band : audit.bands) emitted_ += audit.watts(band, band.emitted);
  }

  /// One line: `quanta_of` picks the power from each band's books.
  void line(const std::string& label, const std::function<double(const BandAudit&)>& quanta_of) {
    std::vector<std::string> cells{label};
    double sum = 0;
    for (const BandAudit& band : audit_.bands) {
      const double watts = audit_.watts(band, quanta_of(band));
      sum += watts;
      cells.push_back(number_text(watts));
    }
    cells.push_back(emitted_ > 0 ? percent_text(sum / emitted_) : "-");
    table_.row(std::move(cells));
  }

  /// One line for each surface that took power, largest first.
  void surfaces(SurfaceQuanta quanta, const std::vector<std::string>& names) {
    for (const std::size_t s : by_power(audit_, quanta, names.size())) {
      if (watts_of_surface(audit_, quanta, s) == 0) continue;
      line("  " + names[s], [&](const BandAudit& band) { return (band.*quanta)[s]; });
    }
  }

  void balance() {
    std::vector<std::string> cells{"balance [quanta]"};
    for (const BandAudit& band : audit_.bands) cells.push_back(std::to_string(band.balance()));
    table_.row(std::move(cells));
  }

  std::string text() const { return table_.text(); }

 private:
  const EnergyAudit& audit_;
  TextTable table_;
  double emitted_ = 0;
};

RunQuanta sum(const std::vector<RunQuanta>& quanta) {
  return std::accumulate(quanta.begin(), quanta.end(), RunQuanta{0});
}

double roulette_loss(const BandAudit& band) {
  return band.roulette_gain - static_cast<double>(band.roulette_net);
}

Json band_json(const EnergyAudit& audit, const BandAudit& band) {
  const auto watts = [&](auto quanta) { return audit.watts(band, quanta); };
  Json escaped_by_direction;
  for (std::size_t d = 0; d < kDirections.size(); ++d)
    escaped_by_direction[kDirections[d]] = watts(band.escaped[d]);
  return {{"name", band.band},
          {"emitted_W", watts(band.emitted)},
          {"absorbed_W", watts(band.total_absorbed())},
          {"absorbed_on_backs_W", watts(sum(band.absorbed_on_backs))},
          {"escaped_W", watts(band.total_escaped())},
          {"escaped_by_direction_W", escaped_by_direction},
          {"unshot_W", watts(band.unshot)},
          {"unshot_share", band.unshot_share()},
          {"roulette_W", watts(-band.roulette_net)},
          {"roulette_gain_W", watts(band.roulette_gain)},
          {"roulette_loss_W", watts(roulette_loss(band))},
          {"balance_quanta", band.balance()},
          {"watts_per_quantum", band.watts_per_quantum}};
}

Json surface_json(const EnergyAudit& audit, const std::string& name, std::size_t surface) {
  Json absorbed = Json::array();
  Json on_backs = Json::array();
  for (const BandAudit& band : audit.bands) {
    absorbed.push_back(audit.watts(band, band.absorbed[surface]));
    on_backs.push_back(audit.watts(band, band.absorbed_on_backs[surface]));
  }
  return {{"name", name}, {"absorbed_W", absorbed}, {"absorbed_on_backs_W", on_backs}};
}

}  // namespace

std::string audit_text(const EnergyAudit& audit, const std::vector<std::string>& surface_names) {
  AuditTable table(audit);
  table.line("emitted", [](const BandAudit& band) { return band.emitted; });
  table.line("absorbed by surfaces", [](const BandAudit& band) { return sum(band.absorbed); });
  table.surfaces(&BandAudit::absorbed, surface_names);
  table.line("absorbed on backs", [](const BandAudit& band) { return sum(band.absorbed_on_backs); });
  table.surfaces(&BandAudit::absorbed_on_backs, surface_names);
  table.line("escaped", [](const BandAudit& band) { return band.total_escaped(); });
  for (std::size_t d = 0; d < kDirections.size(); ++d) {
    const auto escaped = [d](const BandAudit& band) { return band.escaped[d]; };
    const bool any = std::any_of(audit.bands.begin(), audit.bands.end(), escaped);
    if (any) table.line(fmt::format("  towards {}", kDirections[d]), escaped);
  }
  table.line("unshot", [](const BandAudit& band) { return band.unshot; });
  table.line("roulette loss", roulette_loss);
  table.line("roulette gain", [](const BandAudit& band) { return band.roulette_gain; });
  table.balance();
  return table.text() +
         fmt::format("{} over {} batch{}\n",
                     audit.balanced() ? "The books balance exactly" : "THE BOOKS DO NOT BALANCE",
                     audit.batches, audit.batches == 1 ? "" : "es") +
         "Packets are counted here; what 'reemit info' says of surfaces has standard errors, and less noise\n"
         "where shadow rays bring direct light\n" +
         fmt::format(
             "Rays traced twice because they met an edge, a back or nothing: {}; packets that ended on "
             "backs: {}, outside: {}\n"
             "Rays that started behind their face: {}; packets that roulette made more than twice the "
             "usual: {}\n",
             audit.events.second_looks, audit.events.back_hits, audit.events.escapes,
             audit.events.starts_behind, audit.events.roulette_jumps);
}

Json audit_json(const EnergyAudit& audit, const std::vector<std::string>& surface_names) {
  Json bands = Json::array();
  for (const BandAudit& band : audit.bands) bands.push_back(band_json(audit, band));
  Json surfaces = Json::array();
  for (const std::size_t s : by_power(audit, &BandAudit::absorbed, surface_names.size())) {
    surfaces.push_back(surface_json(audit, surface_names[s], s));
  }
  return {{"bands", bands},
          {"balanced", audit.balanced()},
          {"batches", audit.batches},
          {"events",
           {{"second_looks", audit.events.second_looks},
            {"back_hits", audit.events.back_hits},
            {"escapes", audit.events.escapes},
            {"starts_behind", audit.events.starts_behind},
            {"roulette_jumps", audit.events.roulette_jumps}}},
          {"surfaces", surfaces}};
}

}  // namespace reemit::cli
