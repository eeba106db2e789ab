#pragma once
#include <cstdint>
#include <functional>

#include "scenes/model/stop_token.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solver_settings.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Rays that are about to be traced for the first time.
struct RayBlock {
  const Ray16& rays;
  int count;                ///< <= 16
  const std::uint32_t* id;  ///< Of each ray, the number of its packet: in the batch (walks) or in its sweep.
  /// Bounce (walks) or sweep, from 0; mirrors and glass that a packet goes on from do not count.
  std::uint32_t flight;
};

/// Is shown every block of rays before it is traced; called from all threads.
using RayObserver = std::function<void(const RayBlock& block)>;

/// Everything one batch needs to know.
struct BatchTask {
  const PacketRoom& transport;
  const PacketSources& emission;
  const SolverSettings& settings;
  std::uint32_t batch;    ///< Number of the batch: selects its random numbers.
  std::uint32_t packets;  ///< Aimed at; each luminaire zone sends at least one.
  /// Looked at in every sweep and bounce, and every few thousand packets; may be null.
  const StopToken* stop = nullptr;
  const RayObserver* ray_observer = nullptr;  ///< May be null.
  /// Shooting: so many packets travel together on their way from a luminaire to the first surface, of which
  /// little is needed where the direct light of zones is found otherwise.
  std::uint32_t first_together = 1;
};

/// One batch of absorb-and-re-emit shooting: an independent estimate of the whole solution ([GI98] Monte
/// Carlo notes, section 3; all zones at once in the manner of stochastic Jacobi iterations). Zones re-emit
/// from points where the sweep before met them, or uniformly over their area (SolverSettings::reemission).
/// What sweeps leave (SolverSettings::stop_share) is followed to its end by a few walks. False if it was cut
/// off: the books balance all the same, with what was on its way, or had not set out, as unshot. A batch of
/// more than 200,000 sweeps ends there, whole, with the rest unshot. Must run inside the task arena of the
/// caller.
bool shoot_batch(const BatchTask& task, BatchBooks& books);

/// The same up to where packets of luminaires first meet a surface that scatters them: the reflected rest is
/// unshot.
bool shoot_first_flight(const BatchTask& task, BatchBooks& books);

/// One batch of walks: each packet is followed until Russian roulette absorbs it. It survives a hit with the
/// largest reflectance over the bands and keeps rho/largest of its power, so its power never grows and what
/// it loses is absorbed: the books need no correction for roulette. A packet goes on from where it met a
/// zone, or from a uniform point of it (SolverSettings::reemission). False if it was cut off, as above; a
/// walk ends after 200,000 bounces.
bool walk_batch(const BatchTask& task, BatchBooks& books);

}  // namespace reemit
