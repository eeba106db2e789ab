#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/solution/solution.h"
#include "solver/tally/batch_books.h"
#include "solver/tally/energy_audit.h"

namespace reemit {

/// Error of a zone solution as a fraction of its radiosity. Radiosity here is the reflected part rho E: a
/// bright lamp known without error would otherwise hide the noise of the room that it lights.
struct ZoneError {
  double rms = 0;            ///< sqrt(sum A s^2 / sum A (rho E)^2), s = standard error of rho E, worst band.
  double percentile_95 = 0;  ///< 95th percentile of s/(rho E) over the zones with E > 0, worst band.
  std::uint64_t unreached = 0;  ///< Zones that no packet met; they count with s = 0 and cannot block a stop.
};

/// Adds one batch to the sums. `watts_per_quantum`: per band [W]. Deterministic for any number of threads.
void add_batch(const ZoneMesh& mesh, const BatchBooks& books, const std::vector<double>& watts_per_quantum,
               ZoneSums& sums);

/// Adds one batch to the audit. Throws std::logic_error if the books of the batch do not balance.
void add_batch(const BatchBooks& books, EnergyAudit& audit);

/// Error so far; the rms is infinite before two batches.
ZoneError zone_error(const Scene& scene, const ZoneMesh& mesh, const ZoneSums& sums, bool with_percentile);

}  // namespace reemit
