#pragma once
#include <cmath>

#include <Eigen/Core>

namespace reemit {

/// How an iteration ended.
struct IterationEnd {
  int iterations = 0;
  double residual = 0;  ///< |b - M x| / |b|, from the true residual.
};

/// Solves M x = b for a symmetric positive (semi)definite M given as `apply(x)` = M x, starting from x
/// ([HS52]), until the residual is below `tolerance` |b| or no longer falls.
template <class Apply>
IterationEnd conjugate_gradients(const Apply& apply, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                 double tolerance, int most_iterations) {
  IterationEnd end;
  const double scale = b.norm();
  if (!(scale > 0)) {
    x.setZero();
    return end;
  }
  Eigen::VectorXd residual = b - apply(x);
  Eigen::VectorXd direction = residual;
  double square = residual.squaredNorm();
  for (; end.iterations < most_iterations && std::sqrt(square) > tolerance * scale; ++end.iterations) {
    const Eigen::VectorXd image = apply(direction);
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) break;
    const double step = square / curvature;
    x += step * direction;
    residual -= step * image;
    const double next = residual.squaredNorm();
    direction = residual + next / square * direction;
    square = next;
  }
  end.residual = (b - apply(x)).norm() / scale;
  return end;
}

}  // namespace reemit
