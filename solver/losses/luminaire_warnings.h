#pragma once
#include <string>
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {

/// What the user should know about luminaires that all together send out next to nothing, lose light
/// (opening_losses.h), light themselves or stand through a ceiling (lamp_losses.h), with names and shares.
/// Throws Interrupted when `stop` (may be null) is requested.
std::vector<std::string> luminaire_warnings(const PacketRoom& transport, const PacketSources& emission,
                                            const StopToken* stop = nullptr);
/// The same before a solve.
std::vector<std::string> luminaire_warnings(const Scene& scene, const ZoneMesh& mesh);

}  // namespace reemit
