#include "solver/shoot/open_room.h"

#include <algorithm>

#include "solver/shoot/packet_batch.h"

namespace reemit {
namespace {

constexpr double kLeastShare = 0.01;

}  // namespace

bool is_open(const PacketRoom& transport, const PacketSources& emission) {
  constexpr std::uint32_t kProbes = 8192;
  if (emission.sources.empty()) return false;
  SolverSettings settings;
  settings.seed = 0;
  BatchBooks books = transport.new_books();
  walk_batch({transport, emission, settings, 0, kProbes}, books);
  return static_cast<double>(books.events.escapes) >= kLeastShare * static_cast<double>(books.packets);
}

bool is_open(const EnergyAudit& audit) {
  return std::any_of(audit.bands.begin(), audit.bands.end(), [](const BandAudit& band) {
    return static_cast<double>(band.total_escaped()) > kLeastShare * static_cast<double>(band.emitted);
  });
}

}  // namespace reemit
