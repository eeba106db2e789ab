#pragma once
#include <atomic>
#include <vector>

#include "solver/room/room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solution.h"

namespace reemit {

/// What packets bring to the zones of a solution straight from luminaires, all bands together, and what one
/// of them weighs there. They are those of the solution, or as many that are shot for it, where its direct
/// light may be that of shadow rays (DirectSource::kBest). Under a sky packets have unlike power
/// (PacketSources::packet_share): the share of each part of the sky is taken from packets that are shot.
class LuminairePackets {
 public:
  /// Shoots. What is cut off by `interrupt` holds no light.
  LuminairePackets(const Room& room, const Solution& solution, const std::atomic<bool>& interrupt);

  /// Whether the direct light of the solution may be that of shadow rays.
  static bool are_shot_for(const Solution& solution);

  double irradiance(ZoneId zone) const;  ///< [W/m2]
  /// Under a sky the largest irradiance of a zone, about what a point gets that sees the brightest of it;
  /// else 0 [W/m2].
  double largest_sky_irradiance() const { return largest_sky_irradiance_; }
  /// Power of a packet [W], such that the variance of the power on a zone is its mean times this, for packets
  /// at random: sum w^2 / sum w over those that came, or over those that came to its side of its surface if
  /// that is more.
  double watts_per_packet(ZoneId zone) const;
  /// The same for the zones of a surface together.
  double watts_per_packet(SurfaceId surface) const;

 private:
  std::vector<double> shoot(const PacketRoom& transport, const PacketSources& emission,
                            const std::atomic<bool>& interrupt) const;
  void weigh(const PacketRoom& transport, const PacketSources& emission, const std::atomic<bool>& interrupt);

  const Solution& solution_;
  double mean_watts_;               // of all packets
  std::vector<double> irradiance_;  // by zone
  double largest_sky_irradiance_ = 0;
  // Packets there [W]; empty: all have the same power.
  std::vector<double> of_zone_;
  std::vector<double> of_surface_;
};

}  // namespace reemit
