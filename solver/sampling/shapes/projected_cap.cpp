#include "solver/sampling/shapes/projected_cap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/monotone_root.h"
#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {
namespace {

/// asin(y) - y without cancellation.
double asin_excess(double y) {
  if (std::fabs(y) > 0.25) return std::asin(y) - y;
  const double q = y * y;
  double term = y;
  double sum = 0;
  for (int k = 1; k < 14; ++k) {
    term *= q * (2 * k - 1) / (2 * k);
    sum += term / (2 * k + 1);
  }
  return sum;
}

double root(double v) {
  return std::sqrt(std::max(0.0, v));
}

}  // namespace

ProjectedCap::ProjectedCap(double sin_alpha, double cos_alpha, double sin_theta, double cos_theta)
    : sin_alpha_(sin_alpha),
      cos_theta_(cos_theta),
      middle_(sin_theta * cos_alpha),
      from_rim2_(cos_theta * cos_theta + sin_theta * sin_theta * sin_alpha * sin_alpha),
      end_(sin_alpha),
      axis_z_(cos_theta * cos_alpha),
      sin_theta_(sin_theta) {
  if (cos_theta >= sin_alpha) {
    total_ = std::numbers::pi * sin_alpha * sin_alpha * cos_theta;
    return;
  }
  cut_ = sin_alpha > std::fabs(cos_theta)
             ? std::sqrt((sin_alpha - cos_theta) * (sin_alpha + cos_theta)) / sin_theta
             : 0;
  cut_ = std::min(cut_, sin_alpha);
  if (cos_theta < 0) end_ = cut_;
  total_ = end_ > 0 ? std::max(0.0, 2 * half_area(end_)) : 0;
}

double ProjectedCap::to_rim(double y) const {
  return (from_rim2_ - y * y) / (root(1 - y * y) + middle_);
}

double ProjectedCap::chord(double y) const {
  const double half = cos_theta_ * root((sin_alpha_ - y) * (sin_alpha_ + y));
  return std::max(0.0, y < cut_ ? to_rim(y) + half : 2 * half);
}

double ProjectedCap::half_area(double y) const {
  const auto ellipse = [&](double v) {
    return 0.5 * cos_theta_ *
           (v * root((sin_alpha_ - v) * (sin_alpha_ + v)) +
            sin_alpha_ * sin_alpha_ * std::asin(std::min(1.0, v / sin_alpha_)));
  };
  // Integral of sqrt(1 - y^2) - middle, each term of the order of the result.
  const double v = std::min(y, cut_);
  const double rim =
      0.5 * asin_excess(v) - 0.5 * v * v * v / (1 + root(1 - v * v)) + v * from_rim2_ / (1 + middle_);
  const double whole = ellipse(y);
  return rim + (y > cut_ && cut_ > 0 ? 2 * whole - ellipse(cut_) : whole);
}

Vec3 ProjectedCap::sample(double u0, double u1) const {
  if (cut_ == 0) {
    // The ellipse is the projection of the base of the cap, along the normal, onto the sphere.
    const auto d = unit_disk(u0, u1);
    const double base_z = axis_z_ - sin_theta_ * sin_alpha_ * d[0];
    const double lift2 = sin_alpha_ * sin_alpha_ * std::max(0.0, 1 - d[0] * d[0] - d[1] * d[1]);
    return {middle_ + cos_theta_ * sin_alpha_ * d[0], sin_alpha_ * d[1], std::sqrt(base_z * base_z + lift2)};
  }
  const double share = 2 * u0 - 1;
  const double y = monotone_root(
      [&](double t) {
        return ValueAndSlope{half_area(t), chord(t)};
      },
      std::fabs(share) * 0.5 * total_, 0.5 * total_, end_, chord(0), 0);
  const double length = chord(y);
  const double from_rim = (1 - u1) * length + (y < cut_ ? 0 : std::max(0.0, to_rim(y) - 0.5 * length));
  const double rho = root(1 - y * y);
  return {rho - from_rim, std::copysign(y, share), root(from_rim * (2 * rho - from_rim))};
}

std::array<double, 2> ProjectedCap::invert(const Vec3& p) const {
  if (cut_ == 0) {
    // Coordinates in the base: along its projected axis from the component that the lift leaves alone.
    const double b = p.y() / sin_alpha_;
    const double a = (p.x() - middle_) / (cos_theta_ * sin_alpha_);
    return invert_unit_disk(a, b);
  }
  const double y = std::min(std::fabs(p.y()), end_);
  const double length = chord(y);
  const double rho = root(1 - y * y);
  // 1 - sin = cos^2 / (1 + sin): p lies on the circle of radius rho.
  const double from_rim = p.x() > 0 ? p.z() * p.z() / (rho + p.x()) : rho - p.x();
  const double start = y < cut_ ? 0 : std::max(0.0, to_rim(y) - 0.5 * length);
  const double share = std::min(1.0, 2 * half_area(y) / total_);
  return {0.5 * (1 + std::copysign(share, p.y())),
          length > 0 ? std::clamp(1 - (from_rim - start) / length, 0.0, 1.0) : 0.5};
}

}  // namespace reemit
