#include "solver/solution/audit_group.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "solver/solution/file_damage.h"
#include "solver/solution/hdf5_columns.h"

namespace reemit {
namespace {

// Sums of quanta are int64 as a rule. Where one does not fit, a second dataset, NAME_high, has what of each
// is to be multiplied by 2^63 and added.
constexpr RunQuanta kHigh = RunQuanta{1} << 63;

std::string high_name(const std::string& name) {
  return name + "_high";
}

void write_quanta(const Hdf5Group& group, const std::string& name, const std::vector<RunQuanta>& quanta,
                  const Hdf5Shape& shape, const std::string& description) {
  std::vector<std::int64_t> low;
  std::vector<std::int64_t> high;
  for (const RunQuanta q : quanta) {
    low.push_back(static_cast<std::int64_t>(q % kHigh));
    high.push_back(static_cast<std::int64_t>(q / kHigh));
  }
  group.write<std::int64_t>(name, low, shape, "quanta", description);
  if (std::all_of(high.begin(), high.end(), [](std::int64_t h) { return h == 0; })) return;
  group.write<std::int64_t>(high_name(name), high, shape, "2^63 quanta", "to be added: " + description);
}

std::vector<RunQuanta> read_quanta(const Hdf5Group& group, const std::string& name, const Hdf5Shape& shape) {
  const auto low = group.read<std::int64_t>(name, shape);
  std::vector<RunQuanta> quanta(low.begin(), low.end());
  if (!group.has_dataset(high_name(name))) return quanta;
  const auto high = group.read<std::int64_t>(high_name(name), shape);
  for (std::size_t i = 0; i < quanta.size(); ++i) quanta[i] += high[i] * kHigh;
  return quanta;
}

/// Whether no sum of what the books of a band hold overflows, in whatever order it is taken.
bool can_be_added(const BandAudit& band) {
  double in = 0, out = 0;
  const auto add = [&](RunQuanta quanta, double sign) {
    const double signed_quanta = sign * static_cast<double>(quanta);
    (signed_quanta > 0 ? in : out) += std::abs(signed_quanta);
  };
  for (const RunQuanta quanta : {band.emitted, band.roulette_net}) add(quanta, 1);
  for (const RunQuanta quanta : band.absorbed) add(quanta, -1);
  for (const RunQuanta quanta : band.absorbed_on_backs) add(quanta, -1);
  for (const RunQuanta quanta : band.escaped) add(quanta, -1);
  add(band.unshot, -1);
  constexpr double kMost = 0x1p126;
  return in < kMost && out < kMost;
}

}  // namespace

void write_audit(const Hdf5Group& root, const Solution& solution) {
  const Hdf5Group group = root.create_group("audit");
  const auto& bands = solution.audit.bands;
  const std::size_t surfaces = solution.surface_names.size();
  group.write_attribute("batches", solution.audit.batches);
  group.write_attribute("weight", solution.audit.weight);
  group.write_attribute("second_looks", solution.audit.events.second_looks);
  group.write_attribute("back_hits", solution.audit.events.back_hits);
  group.write_attribute("escapes", solution.audit.events.escapes);
  group.write_attribute("starts_behind", solution.audit.events.starts_behind);
  group.write_attribute("roulette_jumps", solution.audit.events.roulette_jumps);
  group.write("band", column<std::string>(bands, std::mem_fn(&BandAudit::band)), "name of each band");
  group.write<double>("watts_per_quantum", column<double>(bands, std::mem_fn(&BandAudit::watts_per_quantum)),
                      {bands.size()}, "W", "power [W] = quanta * watts_per_quantum / weight");
  const auto put_column = [&](const char* name, RunQuanta BandAudit::*member, const char* description) {
    write_quanta(group, name, column<RunQuanta>(bands, std::mem_fn(member)), {bands.size()}, description);
  };
  put_column("emitted", &BandAudit::emitted, "sent out by luminaires");
  put_column("unshot", &BandAudit::unshot, "not sent on when a batch ended");
  put_column("roulette_net", &BandAudit::roulette_net, "created less destroyed by Russian roulette");
  group.write<double>("roulette_gain", column<double>(bands, std::mem_fn(&BandAudit::roulette_gain)),
                      {bands.size()}, "quanta", "created by Russian roulette");
  write_quanta(group, "absorbed", flattened<RunQuanta>(bands, std::mem_fn(&BandAudit::absorbed)),
               {bands.size(), surfaces}, "absorbed by each surface");
  write_quanta(group, "absorbed_on_backs",
               flattened<RunQuanta>(bands, std::mem_fn(&BandAudit::absorbed_on_backs)),
               {bands.size(), surfaces}, "absorbed on the backs of one-sided faces");
  write_quanta(group, "escaped", flattened<RunQuanta>(bands, std::mem_fn(&BandAudit::escaped)),
               {bands.size(), 6}, "left the room towards +x -x +y -y +z -z");
  group.write("warnings", solution.light_warnings, "what was found about light that is lost");
}

void read_audit(const Hdf5Group& root, Solution& solution) {
  const Hdf5Group group = root.open_group("audit");
  const std::uint64_t channels = solution.sums.channels.count();
  const std::uint64_t surfaces = solution.surface_names.size();
  EnergyAudit& audit = solution.audit;
  audit.batches = group.read_attribute<std::int64_t>("batches");
  audit.weight = group.read_attribute<std::int64_t>("weight");
  audit.events.second_looks = group.read_attribute<std::uint64_t>("second_looks");
  audit.events.back_hits = group.read_attribute<std::uint64_t>("back_hits");
  audit.events.escapes = group.read_attribute<std::uint64_t>("escapes");
  audit.events.starts_behind = group.read_attribute<std::uint64_t>("starts_behind");
  audit.events.roulette_jumps = group.read_attribute<std::uint64_t>("roulette_jumps");
  require_intact(audit.batches >= 0 && audit.weight >= audit.batches, "a negative number of batches");
  const std::vector<std::string> names = group.read_texts("band");
  require_intact(names.size() == channels, "an audit of another number of bands");
  const auto watts = group.read<double>("watts_per_quantum", {channels});
  const auto gain = group.read<double>("roulette_gain", {channels});
  require_intact(all_finite(watts) && all_finite(gain), "power that is not finite");
  const auto escaped = read_quanta(group, "escaped", {channels, 6});
  const auto absorbed = read_quanta(group, "absorbed", {channels, surfaces});
  const auto on_backs = read_quanta(group, "absorbed_on_backs", {channels, surfaces});
  audit.bands.resize(channels);
  const auto row = [](const std::vector<RunQuanta>& values, std::size_t b, std::uint64_t columns) {
    return values.begin() + static_cast<std::ptrdiff_t>(b * columns);
  };
  for (std::size_t b = 0; b < channels; ++b) {
    BandAudit& band = audit.bands[b];
    band.band = names[b];
    band.watts_per_quantum = watts[b];
    band.roulette_gain = gain[b];
    std::copy_n(row(escaped, b, 6), 6, band.escaped.begin());
    band.absorbed.assign(row(absorbed, b, surfaces), row(absorbed, b + 1, surfaces));
    band.absorbed_on_backs.assign(row(on_backs, b, surfaces), row(on_backs, b + 1, surfaces));
  }
  const std::pair<const char*, RunQuanta BandAudit::*> columns[] = {
      {"emitted", &BandAudit::emitted},
      {"unshot", &BandAudit::unshot},
      {"roulette_net", &BandAudit::roulette_net}};
  for (const auto& [name, member] : columns) {
    const auto values = read_quanta(group, name, {channels});
    for (std::size_t b = 0; b < channels; ++b) audit.bands[b].*member = values[b];
  }
  require_intact(std::all_of(audit.bands.begin(), audit.bands.end(), can_be_added),
                 "more quanta in the books than can be added");
  solution.light_warnings = group.read_texts("warnings");
}

}  // namespace reemit
