#include "viewer_export/vertex/surrounding_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace reemit {
namespace {

constexpr int kTerms = 6;
constexpr int kTermsOfPlane = 3;
using Terms = Eigen::Matrix<double, kTerms, 1>;

Terms terms_at(double x, double y) {
  Terms t;
  t << 1, x, y, x * x, x * y, y * y;
  return t;
}

/// Weights as a polynomial of places in units of `size`, that of the first `count`.
Terms weights_of(const Surrounding& around, std::size_t count, double size) {
  constexpr std::size_t kForPlane = 5, kForSecondOrder = 12;
  constexpr double kThin = 1e-6;  // of the moments of places that determine no such function
  const Terms mean = Terms::Unit(0) / static_cast<double>(count);
  if (count < kForPlane || !(size > 0)) return mean;
  Eigen::Matrix<double, kTerms, kTerms> moments = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Terms t = terms_at(around.x[i] / size, around.y[i] / size);
    moments += t * t.transpose();
  }
  for (const int terms : {kTerms, kTermsOfPlane}) {
    if (terms == kTerms && count < kForSecondOrder) continue;
    const Eigen::LDLT<Eigen::MatrixXd> solver(moments.topLeftCorner(terms, terms));
    if (!(solver.vectorD().minCoeff() > kThin * static_cast<double>(count))) continue;
    Terms weights = Terms::Zero();
    weights.head(terms) = solver.solve(Eigen::VectorXd::Unit(terms, 0));
    return weights;
  }
  return mean;
}

}  // namespace

void fit_surrounding(const Surrounding& around, std::size_t hops, SurroundingFit& fit) {
  const std::size_t count = around.upto[hops];
  double size = 0;
  for (std::size_t i = 0; i < count; ++i) size = std::max(size, std::hypot(around.x[i], around.y[i]));
  const Terms weights = weights_of(around, count, size);
  fit.weight.assign(count, static_cast<float>(weights[0]));
  for (std::size_t i = 1; i < count && size > 0; ++i)
    fit.weight[i] = static_cast<float>(weights.dot(terms_at(around.x[i] / size, around.y[i] / size)));
}

}  // namespace reemit
