#pragma once
#include <vector>

#include "solver/matrix/form_factors.h"
#include "solver/matrix/leaks.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/energy_audit.h"

namespace reemit {

/// Power of one luminaire without area that reaches no zone.
struct LuminaireLeak {
  Spectrum watts;  ///< [W] per band
  std::vector<LeakAccount> leaks;
};

/// Books the power of a matrix solution as `batches` equal batches. Absorbed power follows from the
/// irradiances; what the form factors of a zone lack to 1 leaves where the leak rays of the zone went, or if
/// all of these met zones, where those of the other zones went. Each account is rounded to quanta. What is
/// then missing from the emitted power goes to `unshot`, so that the books balance: roundings, the residual
/// of the system, and what rows whose sums are off by sampling gain or lose; it may be negative. `radiosity`
/// and `irradiance` [W/m2]: zone x band.
void book_matrix_solution(const PacketRoom& transport, const PacketSources& emission,
                          const FormFactors& factors, const RowMatrix& radiosity, const RowMatrix& irradiance,
                          const std::vector<LuminaireLeak>& light_losses, std::int64_t batches,
                          EnergyAudit& audit);

}  // namespace reemit
