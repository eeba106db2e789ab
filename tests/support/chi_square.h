#pragma once
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace reemit::test {

/// Upper tail of the chi-square distribution: probability to see `statistic` or more with `dof` degrees of
/// freedom when the hypothesis holds. Wilson-Hilferty approximation, good to a few per cent of the
/// probability for dof >= 10.
inline double chi_square_tail(double statistic, double dof) {
  if (dof < 1) throw std::invalid_argument("chi-square test without degrees of freedom");
  const double h = 2.0 / (9.0 * dof);
  const double z = (std::cbrt(statistic / dof) - (1 - h)) / std::sqrt(h);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

/// False alarm odds of every chi-square test of this project: one in 10^6 for a correct program, with fixed
/// seeds, so a test that passes once passes always until the numbers change.
inline constexpr double kFalseAlarm = 1e-6;

/// Pearson's statistic of counts against expected counts; cells expecting less than 10 are pooled.
inline double chi_square_of_counts(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0;
  double pooled_count = 0;
  double pooled_expected = 0;
  std::size_t cells = 0;
  const auto add = [&](double c, double e) {
    statistic += (c - e) * (c - e) / e;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 10) {
      add(counts[i], expected[i]);
    } else {
      pooled_count += counts[i];
      pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= 10) add(pooled_count, pooled_expected);
  return chi_square_tail(statistic, static_cast<double>(cells) - 1);
}

/// A value with its standard error.
struct Measured {
  double mean;
  double stderr_of_mean;
};

/// Probability of a disagreement this large between two independent sets of estimates of the same quantities.
/// The errors come from `batches` batches each, so squared deviations follow (a scaled) F rather than
/// chi-square; the statistic is divided by its expectation (n-1)/(n-3) to allow for that.
inline double agreement(const std::vector<Measured>& a, const std::vector<Measured>& b, double batches) {
  double statistic = 0;
  double dof = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double variance =
        a[i].stderr_of_mean * a[i].stderr_of_mean + b[i].stderr_of_mean * b[i].stderr_of_mean;
    if (!(variance > 0)) continue;
    statistic += (a[i].mean - b[i].mean) * (a[i].mean - b[i].mean) / variance;
    dof += 1;
  }
  return chi_square_tail(statistic * (batches - 3) / (batches - 1), dof);
}

}  // namespace reemit::test
