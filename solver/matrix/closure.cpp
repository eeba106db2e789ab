#include "solver/matrix/closure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "solver/matrix/conjugate_gradients.h"

namespace reemit {
namespace {

constexpr int kMostPasses = 30;
constexpr double kGoodEnough = 1e-13;  // largest deviation of a row sum
/// Keeps the system definite where sampled pairs form a bipartite graph; further passes remove its effect.
constexpr double kRidge = 1e-9;
/// A pair is changed by at most so many of its standard errors: what rows lack beyond that is no noise of the
/// sampled pairs, and those of a small zone would have to bring it for the large one.
constexpr double kMostErrors = 4;

/// Exchange areas after the changes that multipliers of rows stand for; as they were where these are 0.
class ChangedExchange {
 public:
  ChangedExchange(const std::vector<double>& areas, const std::vector<bool>& closed,
                  const SymmetricTable<float>& variance, SymmetricTable<double>& exchange)
      : areas_(areas), closed_(closed), variance_(variance), exchange_(exchange) {}

  Eigen::VectorXd row_sums(const Eigen::VectorXd& multiplier) const {
    return exchange_.row_sums([&](std::size_t i, std::size_t k) { return changed(i, k, multiplier); });
  }

  void keep(const Eigen::VectorXd& multiplier) {
    tbb::parallel_for(std::size_t{0}, areas_.size(), [&](std::size_t i) {
      for (std::size_t k = 0; k < exchange_.row_length(i); ++k)
        exchange_.row(i)[k] = changed(i, k, multiplier);
    });
  }

 private:
  double changed(std::size_t i, std::size_t k, const Eigen::VectorXd& multiplier) const {
    const std::size_t j = i + 1 + k;
    const double value = exchange_.row(i)[k];
    const double weight = static_cast<double>(variance_.row(i)[k]) * areas_[i] * areas_[j];
    if (!(weight > 0) || !closed_[i] || !closed_[j]) return value;
    const double most = kMostErrors * std::sqrt(weight);
    const double change =
        weight * (multiplier(static_cast<Eigen::Index>(i)) + multiplier(static_cast<Eigen::Index>(j)));
    return std::max(0.0, value + std::clamp(change, -most, most));
  }

  const std::vector<double>& areas_;
  const std::vector<bool>& closed_;
  const SymmetricTable<float>& variance_;
  SymmetricTable<double>& exchange_;
};

}  // namespace

void enforce_closure(const std::vector<double>& areas, const std::vector<bool>& closed,
                     const SymmetricTable<float>& variance, SymmetricTable<double>& exchange) {
  const std::size_t zones = areas.size();
  const auto n = static_cast<Eigen::Index>(zones);
  Eigen::VectorXd in_closed_room(n);
  for (std::size_t i = 0; i < zones; ++i) in_closed_room(static_cast<Eigen::Index>(i)) = closed[i] ? 1 : 0;
  const Eigen::Map<const Eigen::VectorXd> target(areas.data(), n);

  // The smallest change is variance * (multiplier_i + multiplier_j); the multipliers solve
  // (diagonal + variance) multiplier = what the rows lack.
  const auto weighted = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return target.cwiseProduct(variance.times(target.cwiseProduct(x)));
  };
  const Eigen::VectorXd diagonal = weighted(in_closed_room).cwiseProduct(in_closed_room);
  if (!(diagonal.maxCoeff() > 0)) return;
  const Eigen::VectorXd scaling = diagonal.unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const auto system = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return (1 + kRidge) * x + scaling.cwiseProduct(weighted(scaling.cwiseProduct(x)));
  };
  ChangedExchange changed(areas, closed, variance, exchange);
  Eigen::VectorXd multiplier = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd best = multiplier;
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::VectorXd lacking = (target - changed.row_sums(multiplier)).cwiseProduct(in_closed_room);
    const Eigen::VectorXd curable =
        lacking.cwiseProduct(diagonal.unaryExpr([](double d) { return d > 0 ? 1.0 : 0.0; }));
    const double deviation = curable.cwiseQuotient(target).cwiseAbs().maxCoeff();
    if (!(deviation < least)) break;
    least = deviation;
    best = multiplier;
    if (deviation < kGoodEnough) break;
    Eigen::VectorXd scaled = Eigen::VectorXd::Zero(n);
    conjugate_gradients(system, scaling.cwiseProduct(curable), scaled, 1e-10, 500);
    multiplier += scaling.cwiseProduct(scaled);
  }
  changed.keep(best);
}

}  // namespace reemit
