#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "solver/solution/energy_audit.h"

namespace reemit::cli {

/// The books as a table for people; powers in W, the balance in quanta. `surface_names` by SurfaceId.
std::string audit_text(const EnergyAudit& audit, const std::vector<std::string>& surface_names);

/// The books as the document of `audit --json` (docs/command_line.md). Per band
/// emitted = absorbed + escaped + unshot + roulette; absorbed counts fronts and backs.
nlohmann::ordered_json audit_json(const EnergyAudit& audit, const std::vector<std::string>& surface_names);

}  // namespace reemit::cli
