#pragma once
#include <cstdint>

#include "solver/shoot/emission.h"
#include "solver/shoot/transport_scene.h"

namespace reemit {

/// Throws InputError when some band is reflected entirely by every surface that packets from the luminaires
/// can meet and no packet leaves the room: radiosity would grow without bound. A room of reflectance 1 with a
/// way out passes.
void refuse_closed_perfect_reflector(const TransportScene& transport, const Emission& emission,
                                     std::uint64_t seed);

}  // namespace reemit
