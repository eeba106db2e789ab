#include "viewer_export/vertex/surrounding_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace reemit {
namespace {

/// Weights are a polynomial of the place: 1, x, y, x^2, xy, y^2.
constexpr int kTerms = 6;
constexpr int kTermsOfPlane = 3;
using Terms = Eigen::Matrix<double, kTerms, 1>;

/// The moment that is the sum of the products of two terms.
constexpr std::size_t kMoment[kTerms][kTerms] = {{0, 1, 2, 3, 4, 5},    {1, 3, 4, 6, 7, 8},
                                                 {2, 4, 5, 7, 8, 9},    {3, 6, 7, 10, 11, 12},
                                                 {4, 7, 8, 11, 12, 13}, {5, 8, 9, 12, 13, 14}};

/// Weights from `Count` terms, for places in units of their size. False where they determine no such
/// function.
template <int Count>
bool solve(const Eigen::Matrix<double, kTerms, kTerms>& moments, double vertices, Terms& weights) {
  constexpr double kThin = 1e-6;  // of the moments of such places
  using Matrix = Eigen::Matrix<double, Count, Count>;
  const Eigen::LDLT<Matrix> solver(Matrix(moments.template topLeftCorner<Count, Count>()));
  if (!(solver.vectorD().minCoeff() > kThin * vertices)) return false;
  weights.setZero();
  weights.template head<Count>() = solver.solve(Eigen::Matrix<double, Count, 1>::Unit(0));
  return true;
}

}  // namespace

SurroundingFits::SurroundingFits(const Surrounding& around) : around_(around) {
  double largest2 = 0;
  std::size_t i = 0;
  for (std::size_t hops = 0; hops < size_.size(); ++hops) {
    for (; i < around.upto[hops]; ++i)
      largest2 = std::max(largest2, around.x[i] * around.x[i] + around.y[i] * around.y[i]);
    size_[hops] = std::sqrt(largest2);
  }
  unit_ = size_.back();
  if (!(unit_ > 0)) return;
  const double per_metre = 1 / unit_;
  Moments sum{};
  i = 0;
  for (std::size_t hops = 0; hops < moments_.size(); ++hops) {
    for (; i < around.upto[hops]; ++i) {
      const double x = per_metre * around.x[i];
      const double y = per_metre * around.y[i];
      const double xx = x * x;
      const double xy = x * y;
      const double yy = y * y;
      const Moments of_place{1,      x,      y,       xx,      xy,      yy,      xx * x, xx * y,
                             x * yy, yy * y, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy};
      for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += of_place[m];
    }
    moments_[hops] = sum;
  }
}

void SurroundingFits::fit(std::size_t hops, SurroundingFit& fit) const {
  constexpr std::size_t kForPlane = 5, kForSecondOrder = 12;
  const std::size_t count = around_.upto[hops];
  const auto vertices = static_cast<double>(count);
  Terms weights = Terms::Unit(0) / vertices;  // the mean
  if (count >= kForPlane && size_[hops] > 0) {
    const double scale = unit_ / size_[hops];
    Terms scales;
    scales << 1, scale, scale, scale * scale, scale * scale, scale * scale;
    Eigen::Matrix<double, kTerms, kTerms> moments;
    for (int i = 0; i < kTerms; ++i)
      for (int j = 0; j < kTerms; ++j) moments(i, j) = scales[i] * scales[j] * moments_[hops][kMoment[i][j]];
    if ((count >= kForSecondOrder && solve<kTerms>(moments, vertices, weights)) ||
        solve<kTermsOfPlane>(moments, vertices, weights))
      for (int k = 1; k < kTerms; ++k) weights[k] *= scales[k] / (k < kTermsOfPlane ? unit_ : unit_ * unit_);
  }
  fit.weight.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = around_.x[i];
    const double y = around_.y[i];
    fit.weight[i] = static_cast<float>(weights[0] + x * (weights[1] + x * weights[3] + y * weights[4]) +
                                       y * (weights[2] + y * weights[5]));
  }
}

}  // namespace reemit
