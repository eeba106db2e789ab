#include "solver/tally/error_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <boost/math/distributions/fisher_f.hpp>

namespace reemit {
namespace {

constexpr double kOdds = 1e-3;

/// Sums of powers of the modes over powers of their sum.
struct ModeMoments {
  double second = 1;  ///< sum lambda^2 / (sum lambda)^2: 1 for one mode, 1/m for m equal ones.
  double third = 1;   ///< sum lambda^3 / (sum lambda)^3
};

/// Unbiased estimates of the products of power sums, from those of a Wishart matrix of `f` degrees of
/// freedom.
ModeMoments mode_moments(const Eigen::MatrixXd& products, double f) {
  // Below this many degrees of freedom the three equations are not independent.
  constexpr double kFewest = 3;
  const double p1 = products.trace();
  if (f < kFewest || !(p1 > 0)) return {};
  const Eigen::MatrixXd square = products * products;
  const Eigen::Vector3d found(1, square.trace() / (p1 * p1),
                              square.cwiseProduct(products).sum() / (p1 * p1 * p1));
  Eigen::Matrix3d expected;
  expected << f * f * f, 6 * f * f, 8 * f,                  //
      f * f, f * f * f + f * f + 4 * f, 4 * f * f + 4 * f,  //
      f, 3 * f * f + 3 * f, f * f * f + 3 * f * f + 4 * f;
  const Eigen::Vector3d sums = expected.partialPivLu().solve(found);
  if (!(sums[0] > 0)) return {};
  // Unbiased means smaller than what this very sample shows: its own share of a mode that stands out is what
  // its squared error is low or high by. Beyond that err towards few modes, by about two standard deviations
  // of what many leave.
  const double pairs = 0.5 * f * (f + 1);
  const double triples = f * (f + 1) * (f - 1) / 6;
  ModeMoments m;
  m.second = std::clamp(sums[1] / sums[0] * (f + 2) / f * (1 + std::sqrt(2 / pairs)), 1e-12, 1.0);
  const double one_mode = std::pow(m.second, 1.5);
  m.third = std::clamp(sums[2] / sums[0] * (f + 2) * (f + 4) / (f * f) + 2 / std::sqrt(triples) * one_mode,
                       m.second * m.second, one_mode);
  return m;
}

}  // namespace

double largest_error_quotient(std::span<const double> products, std::size_t groups) {
  if (groups < 2) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<Eigen::Index>(groups);
  const auto f = static_cast<double>(groups - 1);
  const ModeMoments m = mode_moments(Eigen::Map<const Eigen::MatrixXd>(products.data(), n, n), f);
  const double freedom = std::max(1.0, std::pow(m.second, 3) / (m.third * m.third));
  const double variable = std::min(1.0, m.second * m.second / m.third);
  const boost::math::fisher_f distribution(freedom, freedom * f);
  return 1 + variable * (boost::math::quantile(boost::math::complement(distribution, kOdds)) - 1);
}

}  // namespace reemit
