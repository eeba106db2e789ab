#pragma once
#include <cstddef>
#include <span>

namespace reemit {

/// How many times the estimated squared error the true one can be.
///
/// The true squared error T of a mean over a whole room is a sum over zones and so, for errors near to
/// normal, a sum over modes lambda_j chi2(1); its estimate is the same sum with chi2(f)/f. Where few modes
/// carry the error, T is very skewed and its estimate uncertain. T is taken for a constant plus c times
/// chi2(nu), which matches mean, variance and skewness ([IMH61] section 4) and is exact for equal modes and
/// for one mode on top of many small ones; with the estimate below it, the variable part follows an F
/// distribution. Variance and skewness come from the inner products of the groups' deviations by the moments
/// of Wishart matrices ([LM04]).
///
/// `products`: row by row, sum over zones of the deviations of group g times those of group h from the mean,
/// both times the square root of the group's weight. Returns the quotient that is passed with odds of 0.1 %,
/// >= 1; infinite with fewer than two groups.
double largest_error_quotient(std::span<const double> products, std::size_t groups);

}  // namespace reemit
