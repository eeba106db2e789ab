#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "solver/gather/direct_audit.h"
#include "solver/solution/solution.h"

namespace reemit::cli {

/// The comparison of `audit --direct` for people, with the zones that differ most.
std::string direct_audit_text(const DirectAudit& audit, const Solution& solution);

/// `direct` of `audit --direct --json` (docs/command_line.md).
nlohmann::ordered_json direct_audit_json(const DirectAudit& audit, const Solution& solution);

}  // namespace reemit::cli
