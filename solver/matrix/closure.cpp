#include "solver/matrix/closure.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "solver/matrix/conjugate_gradients.h"

namespace reemit {
namespace {

constexpr int kMostPasses = 30;
constexpr double kGoodEnough = 1e-13;  // largest deviation of a row sum
/// Keeps the system definite where sampled pairs form a bipartite graph; further passes remove its effect.
constexpr double kRidge = 1e-9;

}  // namespace

void enforce_closure(const std::vector<double>& areas, const std::vector<bool>& closed,
                     const SymmetricTable<float>& variance, SymmetricTable<double>& exchange) {
  const std::size_t zones = areas.size();
  const auto n = static_cast<Eigen::Index>(zones);
  Eigen::VectorXd in_closed_room(n);
  for (std::size_t i = 0; i < zones; ++i) in_closed_room(static_cast<Eigen::Index>(i)) = closed[i] ? 1 : 0;
  const Eigen::Map<const Eigen::VectorXd> target(areas.data(), n);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);

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
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::VectorXd lacking = (target - exchange.times(ones)).cwiseProduct(in_closed_room);
    const Eigen::VectorXd curable =
        lacking.cwiseProduct(diagonal.unaryExpr([](double d) { return d > 0 ? 1.0 : 0.0; }));
    if (curable.cwiseQuotient(target).cwiseAbs().maxCoeff() < kGoodEnough) return;
    Eigen::VectorXd scaled = Eigen::VectorXd::Zero(n);
    conjugate_gradients(system, scaling.cwiseProduct(curable), scaled, 1e-10, 500);
    const Eigen::VectorXd multiplier = scaling.cwiseProduct(scaled);
    tbb::parallel_for(std::size_t{0}, zones, [&](std::size_t i) {
      if (!closed[i]) return;
      double* row = exchange.row(i);
      const float* weight = variance.row(i);
      for (std::size_t k = 0; k < exchange.row_length(i); ++k) {
        const std::size_t j = i + 1 + k;
        if (!(weight[k] > 0) || !closed[j]) continue;
        const double change =
            static_cast<double>(weight[k]) * areas[i] * areas[j] *
            (multiplier(static_cast<Eigen::Index>(i)) + multiplier(static_cast<Eigen::Index>(j)));
        row[k] = std::max(0.0, row[k] + change);
      }
    });
  }
}

}  // namespace reemit
