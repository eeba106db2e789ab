#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "scenes/model/stop_token.h"
#include "solver/gather/caustic_shooter.h"
#include "solver/gather/photon_radii.h"
#include "solver/solution/gather_plan.h"

namespace reemit {

/// All photons of a room, with their radii.
struct CausticShots {
  static constexpr std::size_t kParts = 16;

  std::uint32_t packets = 0;                  ///< Of all parts together; 0: there is no such light.
  std::array<CausticPhotons, kParts> parts;   ///< Each an estimate of all such light by itself.
  std::array<CausticPhotons, kParts> in_air;  ///< The same on sheets in the air.
};

/// Of `parts` estimates that are means of all, number p.
CausticPhotons mean_of_parts(std::array<CausticPhotons, CausticShots::kParts>& all, std::size_t p,
                             std::size_t parts);

/// How far from points in the air photons of the pilot count: about photons that count for the point.
inline constexpr float kPilotReach = 2 * kLargestPhotonRadius;

/// As many packets as bring a good number of photons, or the most that are worth their time. With `known`
/// (may be null) those alone set out that are known to bring photons, and the photons are the same; unless
/// these are not the packets of this room, which is noticed: then all do. When `stop` (may be null) is
/// requested it ends early, with less light than there is.
CausticShots shoot_caustics(const CausticShooter& shooter, const CausticPackets* known,
                            const StopToken* stop);
/// All packets, and photons on sheets as well, whose reach is kPilotReach: there of `rounds` >= 1 times as
/// many packets, in radii that hold as many times more.
CausticShots shoot_caustics(const CausticShooter& shooter, const AirSheets& sheets, int rounds,
                            const StopToken* stop);

/// What shoot_caustics asks for as `known`; means nothing when `stop` (may be null) was requested.
CausticPackets find_caustic_packets(const CausticShooter& shooter, const StopToken* stop);

}  // namespace reemit
