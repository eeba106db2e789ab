#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bench/validation/reference_cases.h"

namespace reemit::validation {

/// Independent estimates of one quantity, all with the same distribution.
using Estimates = std::vector<double>;

/// One comparison of a measured value with a reference.
struct ValidationRow {
  std::string id;    ///< Of the reference value.
  std::string kind;  ///< Of the reference case.
  std::string method;
  double expected = 0;
  double expected_abs_err = 0;  ///< Of the reference, as it states it.
  double measured = 0;
  double standard_error = 0;  ///< Of the mean of independent estimates; 0 for values without chance.
  /// Stated bound of what is not noise: tessellation, single precision, the power left unshot.
  double numerical_bound = 0;
  int freedom = 0;  ///< Degrees of freedom of the standard error; 0 for values without chance.

  /// What the deviation is divided by: noise, numerical bound and the error of the reference together.
  double uncertainty() const;
  /// (measured - expected)/uncertainty; 0 when they are the same number, infinite when they differ and the
  /// uncertainty is 0.
  double deviation() const;
  /// Is its deviation a matter of chance? Else the numerical bound or the error of the reference is a third
  /// of the standard error or more, and deviations should stay below 1.
  bool is_noisy() const;
  double relative_error() const;  ///< standard_error/|expected|; 0 where 0 is expected and measured.
  /// Odds that a right program is off by `limit` or more either way: Student's t; 0 without noise.
  double odds_beyond(double limit) const;
};

/// Mean of the estimates as a row. `relative_bound`: numerical_bound per |expected|.
ValidationRow make_row(const ReferenceCase& c, const ReferenceValue& v, const std::string& method,
                       const Estimates& estimates, double relative_bound);

/// Density of Student's t with `freedom` degrees of freedom.
double student_density(double t, int freedom);

/// How much work is put into each row.
struct Effort {
  double work = 1;  ///< Of the full validation; standard errors grow as 1/sqrt(work). (0, 100].
};

/// A number that depends on the text alone: seeds of a row do not change when others come and go.
std::uint64_t seed_of(const std::string& text);

}  // namespace reemit::validation
