#pragma once
#include <cstdint>

#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// Throws InputError when a luminaire shines into a part of the room that nothing leaves and whose surfaces
/// reflect some band entirely: radiosity there would grow without bound. It names the luminaire, the surfaces
/// of the part and the band. Each luminaire (zone by zone) is looked at by itself, so a sealed cell is found
/// within a room that absorbs. A part with a way out passes; one whose way out is met by less than one in
/// some 100,000 bounces may be taken for sealed. Sealed parts in the dark are of no concern.
void refuse_closed_perfect_reflector(const PacketRoom& transport, const PacketSources& emission,
                                     std::uint64_t seed);

}  // namespace reemit
