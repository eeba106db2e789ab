#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "solver/reflect/surface_model.h"
#include "solver/solution/energy_audit.h"
#include "solver/solution/solution.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Error of a zone solution as a fraction of its radiosity. Radiosity here is the reflected part rho E: a
/// bright lamp known without error would otherwise hide the noise of the room that it lights. In rooms that
/// reflect nothing it is E itself.
struct ZoneError {
  double rms = 0;  ///< sqrt(sum A s^2 / sum A (rho E)^2), s = standard error of rho E, worst band.
  /// What the true rms error of these very values stays below with odds of 99.9 %. rms is the mean of what it
  /// can be; how far one run strays from that mean shows in how the deviations of the batch groups are
  /// correlated (largest_error_quotient).
  double bound = 0;
  double percentile_95 = 0;     ///< 95th percentile of s/(rho E) over the zones with E > 0, worst band.
  std::uint64_t unreached = 0;  ///< Zones that no packet met; they count with s = 0 and cannot block a stop.
};

/// Adds one batch of weight `weight` >= 1 (ZoneSums) to the sums. `watts_per_quantum`: per channel [W].
/// Deterministic for any number of threads.
void add_batch(const ZoneMesh& mesh, const BatchBooks& books, const std::vector<double>& watts_per_quantum,
               std::int64_t weight, ZoneSums& sums);

/// Adds one batch to the audit, with the same weight, so that powers are those of the sums. Throws
/// std::logic_error if the books of the batch do not balance.
void add_batch(const BatchBooks& books, std::int64_t weight, EnergyAudit& audit);

/// Replaces the sums of value i = zone * channels + channel by what gives the means, and the standard errors
/// that follow from the spread, of independent estimates of its irradiance [W/m2]: one per group that has
/// batches, that is min(kGroups, batches) of them, taken as equally good. What batches found of caustics is
/// kept; it is independent of them. Pre: batches > 0.
void store_replicates(ZoneSums& sums, std::size_t i, std::span<const double> direct,
                      std::span<const double> indirect);

/// Rms error so far; infinite before two batches.
double zone_rms_error(const SurfaceModel& surfaces, const ZoneMesh& mesh, const ZoneSums& sums);
/// All that is known about the error; everything but `unreached` is infinite before two batches.
ZoneError zone_error(const SurfaceModel& surfaces, const ZoneMesh& mesh, const ZoneSums& sums);

}  // namespace reemit
