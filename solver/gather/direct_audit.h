#pragma once
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

struct DirectAuditSettings {
  /// Points of each zone, each with one shadow ray, rounded up to a multiple of kReplicates [1, 2^20].
  int points = 256;
  /// Odds that a sound room has a zone which differs (0, 1).
  double false_alarm = 1e-3;
  std::uint64_t seed = 1;
};

/// Irradiance straight from the luminaires on one zone, all bands together [W/m2].
struct DirectDifference {
  ZoneId zone;
  double by_packets = 0;  ///< What first hits of packets brought.
  double by_samples = 0;  ///< What shadow rays to sampled luminaire points find, on average over the zone.
  double limit = 0;       ///< Largest difference that chance explains.
  bool differs() const { return std::abs(by_packets - by_samples) > limit; }
};

/// Power straight from the luminaires on the compared zones of one surface, all bands together [W].
struct SurfaceDirect {
  double by_packets = 0;
  double by_samples = 0;
  double limit = 0;  ///< Largest difference that chance explains.
  bool differs() const { return std::abs(by_packets - by_samples) > limit; }
};

struct DirectAudit {
  std::size_t compared = 0;  ///< Zones.
  /// Zones that were found by gathering in the solve (too small for packets): both ways would be one.
  std::size_t left_out = 0;
  std::vector<SurfaceDirect> surfaces;      ///< By SurfaceId.
  std::vector<DirectDifference> different;  ///< Zones, by falling power of the difference.

  /// No zone and no surface differs.
  bool agrees() const;
};

/// Compares the direct light that packets bring to the zones with what DirectLight finds on them. The packets
/// are those of the solution, or, where its own direct light may be that of shadow rays
/// (DirectSource::kBest), as many that are shot for it. The two share the room and its rays, but nothing of
/// the choice of luminaires, of points on them, or of what a shadow ray stops at. The limit of a zone is
/// Bernstein's bound for the packets on it [BLM13, cor. 2.11], each of the power that packets have there
/// (LuminairePackets), plus as many standard errors of the samples, for the odds `false_alarm` over all zones
/// together, and 0.3 % for float arithmetic; likewise for surfaces. Pre: the room of the solution. Throws
/// InputError when the solution has no packets (matrix method). When `interrupt` becomes true, returns what
/// was compared. `progress` (may be empty): share done [0,1], rising; called from many threads, one at a
/// time.
DirectAudit audit_direct_light(const Room& room, const Solution& solution,
                               const DirectAuditSettings& settings,
                               const std::function<void(double)>& progress,
                               const std::atomic<bool>& interrupt);

}  // namespace reemit
