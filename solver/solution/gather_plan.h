#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace reemit {

/// Which packets of luminaires become photons behind mirrors and glass (CausticMap): often one of hundreds,
/// and all others need not set out again.
struct CausticPackets {
  std::uint32_t packets = 0;  ///< Of all parts together; 0: none becomes a photon.
  /// By part, bit i % 8 of byte i / 8: 1 if packet i brings photons.
  std::vector<std::vector<std::uint8_t>> brings;
  std::vector<std::uint8_t> radius_codes;  ///< By photon of all parts, the radius of its kernel.
};

/// What gathers find out about a solved room before their first ray. It depends on the room and its zones
/// alone, not on points or cameras, and so is found once. A part that is missing is found where it is needed.
struct GatherPlan {
  std::uint64_t seed = 0;            ///< Of the random numbers it was found with.
  std::vector<std::uint8_t> uneven;  ///< By zone (uneven_zones.h); empty: nobody has looked.
  std::optional<CausticPackets> caustics;
};

}  // namespace reemit
