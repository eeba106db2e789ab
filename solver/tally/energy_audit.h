#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reemit {

/// Where every quantum of power went, summed over all batches. Integers: emitted + roulette_gain = absorbed +
/// absorbed_on_backs + escaped + unshot + roulette_loss holds exactly for each band at any moment.
struct BandAudit {
  std::string band;
  double watts_per_quantum = 0;  ///< Of one batch; power [W] = quanta * watts_per_quantum / batches.
  std::int64_t emitted = 0;
  std::vector<std::int64_t> absorbed;           ///< By SurfaceId, by surfaces that reflect the rest.
  std::vector<std::int64_t> absorbed_on_backs;  ///< By SurfaceId, on the backs of one-sided faces.
  /// Left the room; by the axis nearest to the direction: +x, -x, +y, -y, +z, -z.
  std::array<std::int64_t, 6> escaped{};
  /// Reflected but not sent on when a batch ended (shooting); what rounding and sampling leave, of either
  /// sign (matrix).
  std::int64_t unshot = 0;
  std::int64_t roulette_gain = 0;
  std::int64_t roulette_loss = 0;

  std::int64_t total_absorbed() const;  ///< Fronts and backs of all surfaces.
  std::int64_t total_escaped() const;
  /// emitted - absorbed - escaped - unshot + roulette gain - loss; 0 unless the program is wrong.
  std::int64_t balance() const;
};

struct EnergyAudit {
  std::vector<BandAudit> bands;
  std::int64_t batches = 0;

  bool balanced() const;
  double watts(const BandAudit& band, std::int64_t quanta) const {
    return batches > 0 ? static_cast<double>(quanta) * band.watts_per_quantum / static_cast<double>(batches)
                       : 0.0;
  }
};

}  // namespace reemit
