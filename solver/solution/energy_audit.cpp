#include "solver/solution/energy_audit.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace reemit {

RunQuanta BandAudit::total_absorbed() const {
  return std::accumulate(absorbed.begin(), absorbed.end(), RunQuanta{0}) +
         std::accumulate(absorbed_on_backs.begin(), absorbed_on_backs.end(), RunQuanta{0});
}

RunQuanta BandAudit::total_escaped() const {
  return std::accumulate(escaped.begin(), escaped.end(), RunQuanta{0});
}

double BandAudit::unshot_share() const {
  return emitted > 0 ? static_cast<double>(unshot) / static_cast<double>(emitted) : 0.0;
}

std::int64_t BandAudit::balance() const {
  using Limits = std::numeric_limits<std::int64_t>;
  const RunQuanta rest = emitted + roulette_net - total_absorbed() - total_escaped() - unshot;
  return static_cast<std::int64_t>(std::clamp<RunQuanta>(rest, Limits::min(), Limits::max()));
}

bool EnergyAudit::balanced() const {
  return std::all_of(bands.begin(), bands.end(), [](const BandAudit& b) { return b.balance() == 0; });
}

double EnergyAudit::emitted_watts() const {
  double sum = 0;
  for (const BandAudit& band : bands) sum += watts(band, band.emitted);
  return sum;
}

double EnergyAudit::unshot_share() const {
  double unshot = 0;
  double emitted = 0;
  for (const BandAudit& b : bands) {
    unshot += static_cast<double>(b.unshot);
    emitted += static_cast<double>(b.emitted);
  }
  return emitted > 0 ? unshot / emitted : 0.0;
}

double EnergyAudit::worst_unshot_share() const {
  double worst = 0;
  for (const BandAudit& b : bands) worst = std::max(worst, b.unshot_share());
  return worst;
}

}  // namespace reemit
