#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace reemit {

/// A sum of quanta over a run. A batch has 2^42 for each channel, times its weight: after 2^21 of the
/// smallest batches, some 10^11 packets, 63 bits would be full.
__extension__ using RunQuanta = __int128;

/// Where every quantum of power in one channel went, summed over all batches by their weights. Integers:
/// emitted + roulette_net = absorbed + absorbed_on_backs + escaped + unshot holds exactly for each channel at
/// any moment.
struct BandAudit {
  std::string band;              ///< Its name.
  double watts_per_quantum = 0;  ///< Of one batch; power [W] = quanta * watts_per_quantum / weight.
  RunQuanta emitted = 0;
  std::vector<RunQuanta> absorbed;           ///< By SurfaceId, by surfaces that reflect the rest.
  std::vector<RunQuanta> absorbed_on_backs;  ///< By SurfaceId, on the backs of one-sided faces.
  /// Left the room; by the axis nearest to the direction: +x, -x, +y, -y, +z, -z.
  std::array<RunQuanta, 6> escaped{};
  /// Reflected but not sent on when a batch ended, or not sent out at all by one that was cut off; what
  /// rounding and sampling leave, of either sign (matrix).
  RunQuanta unshot = 0;
  RunQuanta roulette_net = 0;  ///< Gain less loss; 0, for what changes hands cancels.
  /// Power that changed hands [quanta], every time anew: in bright rooms many times what was emitted. For
  /// information, so a floating-point number will do.
  double roulette_gain = 0;

  RunQuanta total_absorbed() const;  ///< Fronts and backs of all surfaces.
  RunQuanta total_escaped() const;   ///< In all directions.
  /// unshot over emitted; 0 if nothing was emitted.
  double unshot_share() const;
  /// emitted - absorbed - escaped - unshot + roulette; 0 unless the program is wrong; what 64 bits do not
  /// hold is cut off at their ends.
  std::int64_t balance() const;
};

/// Ends of packets that ought to be rare, as numbers of packets: more of them than usual point at a room or a
/// program that has something wrong.
struct RareEvents {
  std::uint64_t second_looks = 0;  ///< Rays traced again: they met an edge, a back, or nothing by a hairline.
  std::uint64_t back_hits = 0;     ///< Packets that ended on the back of a one-sided face.
  std::uint64_t escapes = 0;       ///< Packets that left the room.
  /// Rays whose start, lifted off a flat face, lay on the other side of it than that which they left:
  /// rounding took more than the lift. Starts on curved shapes are not looked at.
  std::uint64_t starts_behind = 0;
  /// Packets that came out of roulette with more than twice the usual power in some channel, that is of a
  /// packet of their sweep (shooting) or of what arrived (walks, mirrors and glass): few packets that carry
  /// much are noise.
  std::uint64_t roulette_jumps = 0;

  RareEvents& operator+=(const RareEvents& more) {
    second_looks += more.second_looks;
    back_hits += more.back_hits;
    escapes += more.escapes;
    starts_behind += more.starts_behind;
    roulette_jumps += more.roulette_jumps;
    return *this;
  }
};

struct EnergyAudit {
  std::vector<BandAudit> bands;  ///< By channel (Channels).
  std::int64_t batches = 0;
  std::int64_t weight = 0;  ///< Of all batches together (ZoneSums).
  RareEvents events;        ///< None are counted by the matrix method.

  bool balanced() const;              ///< BandAudit::balance of every channel is 0.
  double unshot_share() const;        ///< Of all bands together, each band counting alike.
  double worst_unshot_share() const;  ///< Of the band with most.
  double emitted_watts() const;       ///< Of all channels together [W].
  /// Power [W] of a number of quanta of this band.
  double watts(const BandAudit& band, RunQuanta quanta) const {
    return watts(band, static_cast<double>(quanta));
  }
  double watts(const BandAudit& band, double quanta) const {
    return weight > 0 ? quanta * band.watts_per_quantum / static_cast<double>(weight) : 0.0;
  }
};

}  // namespace reemit
