#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reemit {

/// Where every quantum of power went, summed over all batches by their weights. Integers: emitted +
/// roulette_net = absorbed + absorbed_on_backs + escaped + unshot holds exactly for each band at any moment.
struct BandAudit {
  std::string band;
  double watts_per_quantum = 0;  ///< Of one batch; power [W] = quanta * watts_per_quantum / weight.
  std::int64_t emitted = 0;
  std::vector<std::int64_t> absorbed;           ///< By SurfaceId, by surfaces that reflect the rest.
  std::vector<std::int64_t> absorbed_on_backs;  ///< By SurfaceId, on the backs of one-sided faces.
  /// Left the room; by the axis nearest to the direction: +x, -x, +y, -y, +z, -z.
  std::array<std::int64_t, 6> escaped{};
  /// Reflected but not sent on when a batch ended, or not sent out at all by one that was cut off; what
  /// rounding and sampling leave, of either sign (matrix).
  std::int64_t unshot = 0;
  std::int64_t roulette_net = 0;  ///< Gain less loss; 0, for what changes hands cancels.
  /// Power that changed hands [quanta], every time anew: in bright rooms many times what was emitted, more
  /// than 63 bits hold in long runs. For information, so a floating-point number will do.
  double roulette_gain = 0;

  std::int64_t total_absorbed() const;  ///< Fronts and backs of all surfaces.
  std::int64_t total_escaped() const;
  /// unshot over emitted; 0 if nothing was emitted.
  double unshot_share() const;
  /// emitted - absorbed - escaped - unshot + roulette; 0 unless the program is wrong.
  std::int64_t balance() const;
};

/// Ends of packets that ought to be rare, as numbers of packets: more of them than usual point at a room or a
/// program that has something wrong.
struct RareEvents {
  std::uint64_t second_looks = 0;  ///< Rays that met an edge, a back or nothing, and were traced once more.
  std::uint64_t back_hits = 0;     ///< Packets that ended on the back of a one-sided face.
  std::uint64_t escapes = 0;       ///< Packets that left the room.

  RareEvents& operator+=(const RareEvents& more) {
    second_looks += more.second_looks;
    back_hits += more.back_hits;
    escapes += more.escapes;
    return *this;
  }
};

struct EnergyAudit {
  std::vector<BandAudit> bands;
  std::int64_t batches = 0;
  std::int64_t weight = 0;  ///< Of all batches together (ZoneSums).
  RareEvents events;        ///< None are counted by the matrix method.

  bool balanced() const;
  double unshot_share() const;  ///< Of all bands together, each band counting alike.
  double worst_unshot_share() const;
  /// Power [W] of a number of quanta of this band.
  double watts(const BandAudit& band, std::int64_t quanta) const {
    return watts(band, static_cast<double>(quanta));
  }
  double watts(const BandAudit& band, double quanta) const {
    return weight > 0 ? quanta * band.watts_per_quantum / static_cast<double>(weight) : 0.0;
  }
};

}  // namespace reemit
