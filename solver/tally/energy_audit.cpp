#include "solver/tally/energy_audit.h"

#include <algorithm>
#include <numeric>

namespace reemit {

std::int64_t BandAudit::total_absorbed() const {
  return std::accumulate(absorbed.begin(), absorbed.end(), std::int64_t{0}) +
         std::accumulate(absorbed_on_backs.begin(), absorbed_on_backs.end(), std::int64_t{0});
}

std::int64_t BandAudit::total_escaped() const {
  return std::accumulate(escaped.begin(), escaped.end(), std::int64_t{0});
}

std::int64_t BandAudit::balance() const {
  return emitted + roulette_gain - roulette_loss - total_absorbed() - total_escaped() - unshot;
}

bool EnergyAudit::balanced() const {
  return std::all_of(bands.begin(), bands.end(), [](const BandAudit& b) { return b.balance() == 0; });
}

}  // namespace reemit
