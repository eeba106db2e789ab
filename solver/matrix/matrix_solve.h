#pragma once
#include <atomic>
#include <functional>

#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Solves the zonal system B = M + rho (F B + E_p) of each band ([GI98] Monte Carlo notes, eq. 4) with the
/// form factors of compute_form_factors and the irradiance E_p of luminaires without area. The system is made
/// symmetric by sqrt(rho A) and solved by conjugate gradients to a residual of 1e-13, at least 1e-10.
/// Errors: the sampled parts of F and E_p vary in 16 replicates with their standard errors, and what follows
/// for the zones is stored as the spread of 16 batches. Fills sums, audit, form_factors, record.rays and
/// record.stopped of the solution; runs in the task arena of the caller. Throws InputError when the system
/// has no finite solution, and what compute_form_factors throws.
void solve_by_matrix(const PacketRoom& transport, const PacketSources& emission,
                     const std::function<void(double)>& progress, const std::atomic<bool>& interrupt,
                     Solution& solution);

}  // namespace reemit
