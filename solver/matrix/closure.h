#pragma once
#include <vector>

#include <Eigen/Core>

#include "solver/matrix/symmetric_table.h"

namespace reemit {

/// Changes sampled exchange areas such that the rows of closed zones sum to the areas of their zones. Among
/// all symmetric changes of pairs with variance > 0 between closed zones it makes the one with the smallest
/// sum of (change)^2 / variance, that is the most likely one, and keeps exchange areas >= 0 and changes
/// within four standard errors; so rows may still lack something. The largest deviation of a row is not
/// larger afterwards than before. Pairs without variance stay as they are; a row that has no others cannot be
/// changed. `variance`: of A_i F_ij, divided by A_i A_j.
void enforce_closure(const std::vector<double>& areas, const std::vector<bool>& closed,
                     const SymmetricTable<float>& variance, SymmetricTable<double>& exchange);

}  // namespace reemit
