#pragma once
#include <vector>

#include "bench/validation/validation_row.h"

namespace reemit::validation {

/// Rows of zone_* and lroom_zone by form factors of all zones (solver/matrix). Effort does not apply.
std::vector<ValidationRow> evaluate_matrix(const std::vector<ReferenceCase>& cases);

}  // namespace reemit::validation
