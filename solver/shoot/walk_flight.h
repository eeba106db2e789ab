#pragma once
#include <cstdint>

#include "solver/shoot/arrival_points.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"

namespace reemit {

/// Follows the packets of a flight until Russian roulette absorbs each (walk_batch). `number` is that of the
/// flight: 0 for one of luminaires, whose light is direct where it first meets a zone; the random numbers of
/// what follows are those of number + 1, .... Zones send their packets from `points`, if given. False if it
/// was cut off. Must run inside the task arena of the caller.
bool walk_flight(const BatchTask& task, const Flight& flight, std::uint32_t number,
                 const ArrivalPoints* points, BatchBooks& books);

}  // namespace reemit
