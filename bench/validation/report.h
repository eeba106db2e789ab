#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bench/validation/cube_convergence.h"
#include "bench/validation/validation_row.h"

namespace reemit::validation {

/// What a set of rows comes to.
struct RowSummary {
  std::size_t rows = 0;
  std::size_t noisy = 0;
  double largest_deviation = 0;            ///< Absolute, over all rows.
  double largest_relative_error = 0;       ///< Standard error over value.
  double largest_bound_share = 0;          ///< Numerical bound over standard error, noisy rows.
  std::size_t beyond_2 = 0, beyond_3 = 0;  ///< Noisy rows.
  double expected_beyond_2 = 0, expected_beyond_3 = 0, expected_beyond_4 = 0;
};
RowSummary summarize(const std::vector<ValidationRow>& rows);

/// Writes validation.csv and, from bench/validation/page.md.in, validation.md with its plots into `folder`.
/// Throws ResourceError when something cannot be written.
void write_report(const std::vector<ValidationRow>& rows, const std::vector<CubeStep>& steps,
                  const std::filesystem::path& folder);

}  // namespace reemit::validation
