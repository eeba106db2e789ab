#pragma once
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/energy_audit.h"

namespace reemit {

/// Whether so much light leaves the room, 1 % and more, that no ray which meets nothing needs a second look
/// (RayTracer::believe_misses). Follows some 4,096 packets over 16 surfaces at most, the same always, each
/// ray looked at twice. Mirrors and glass are taken to scatter what they send on.
bool is_open(const PacketRoom& transport, const PacketSources& emission);

/// The same from the books of a run, for who shows its solution.
bool is_open(const EnergyAudit& audit);

}  // namespace reemit
