#include "bench/hit_paths/opening_hit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace reemit::hit_paths {
namespace {

using std::numbers::pi;
using Shape = LuminousOpening::Shape;

/// Within this many sizes of the opening irradiance grows no more (docs/ies.md, the near field).
constexpr double kNearest = 1e-3;

int flat_axes(const Vec3& size) {
  return static_cast<int>((size.array() <= 0).count());
}

/// Perimeter of an ellipse by its half axes.
double perimeter(double a, double b) {
  const double greater = std::max(a, b);
  const double lesser = std::min(a, b);
  return 4 * greater * std::comp_ellint_2(std::sqrt(1 - lesser * lesser / (greater * greater)));
}

}  // namespace

OpeningHit::OpeningHit(const PhotometricLight& light, std::shared_ptr<const Photometry> photometry,
                       double clearance)
    : light_(&light),
      photometry_(std::move(photometry)),
      size_(light.opening.size()),
      clearance_(clearance),
      nearest_(kNearest * size_.maxCoeff()) {
  const int flat = flat_axes(size_);
  switch (light.opening.shape) {
    case Shape::kPoint:
      size_.setZero();
      nearest_ = 0;
      return;
    case Shape::kBox:
      can_be_hit_ = flat < 2;
      return;
    case Shape::kCylinder: {
      const auto axis = static_cast<Eigen::Index>(light.opening.axis);
      const double a = 0.5 * size_[(axis + 1) % 3];
      const double b = 0.5 * size_[(axis + 2) % 3];
      if (!(a > 0 && b > 0)) break;
      const double mantle = size_[axis] * perimeter(a, b);
      const double whole = mantle + (size_[axis] > 0 ? 2 : 1) * pi * a * b;
      side_ = mantle / whole;
      cap_ = pi * a * b / whole;
      can_be_hit_ = true;
      return;
    }
    case Shape::kEllipsoid:
      if (flat > 0) break;
      can_be_hit_ = true;
      return;
  }
  throw std::invalid_argument("flat measured openings of this kind are not in the reference");
}

/// Calls `use(t, density)` for each crossing of the line o + t d with the opening, in luminaire coordinates:
/// `density` [1/m2] is the opening's share of light per area across the line, its share per area of the
/// opening over the cosine.
template <class Use>
void OpeningHit::for_each_crossing(const Vec3& o, const Vec3& d, Use&& use) const {
  const Vec3 half = 0.5 * size_;
  const auto plane = [&](Eigen::Index axis, double height, double share, bool round) {
    const double t = (height - o[axis]) / d[axis];
    if (!std::isfinite(t)) return;
    const Eigen::Index a = (axis + 1) % 3;
    const Eigen::Index b = (axis + 2) % 3;
    const double x = (o[a] + t * d[a]) / half[a];
    const double y = (o[b] + t * d[b]) / half[b];
    const bool inside = round ? x * x + y * y <= 1 : std::abs(x) <= 1 && std::abs(y) <= 1;
    if (inside) use(t, share / ((round ? pi : 4.0) * half[a] * half[b] * std::abs(d[axis])));
  };
  // t of a unit sphere or circle: a t^2 + 2 b t + c = 0, and the slope of the surface along the line there.
  const auto both_roots = [&](double a, double b, double c, auto&& meet) {
    const double root = b * b - a * c;
    if (!(root > 0 && a > 0)) return;
    for (const double sign : {-1.0, 1.0}) meet((-b + sign * std::sqrt(root)) / a, std::sqrt(root));
  };
  if (light_->opening.shape == Shape::kEllipsoid) {
    const Vec3 p = o.cwiseQuotient(half);
    const Vec3 q = d.cwiseQuotient(half);
    both_roots(q.squaredNorm(), p.dot(q), p.squaredNorm() - 1,
               [&](double t, double slope) { use(t, 1 / (4 * pi * half.prod() * slope)); });
  } else if (light_->opening.shape == Shape::kCylinder) {
    const auto axis = static_cast<Eigen::Index>(light_->opening.axis);
    plane(axis, half[axis], cap_, true);
    if (!(half[axis] > 0)) return;
    plane(axis, -half[axis], cap_, true);
    const Eigen::Index a = (axis + 1) % 3;
    const Eigen::Index b = (axis + 2) % 3;
    const Eigen::Vector2d p(o[a] / half[a], o[b] / half[b]);
    const Eigen::Vector2d q(d[a] / half[a], d[b] / half[b]);
    both_roots(q.squaredNorm(), p.dot(q), p.squaredNorm() - 1, [&](double t, double slope) {
      if (std::abs(o[axis] + t * d[axis]) <= half[axis])
        use(t, side_ / (2 * pi * size_[axis] * half[a] * half[b] * slope));
    });
  } else {
    const std::array<double, 3> faces{size_[1] * size_[2], size_[2] * size_[0], size_[0] * size_[1]};
    const double whole = 2 * (faces[0] + faces[1] + faces[2]);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double share = faces[static_cast<std::size_t>(axis)] / whole;
      if (!(share > 0)) continue;
      if (size_[axis] > 0) {
        plane(axis, half[axis], share, false);
        plane(axis, -half[axis], share, false);
      } else {
        plane(axis, 0, 1, false);
      }
    }
  }
}

double OpeningHit::radiance(const Vec3& origin, const Vec3& direction, double far) const {
  const Vec3 away = origin - light_->position;
  // A sphere about all of it tells most rays apart.
  const double middle = -away.dot(direction);
  if (away.squaredNorm() - middle * middle > 0.2500001 * size_.squaredNorm()) return 0;
  const Vec3 o = light_->orientation.transpose() * away;
  const Vec3 d = light_->orientation.transpose() * direction;
  double sum = 0;
  for_each_crossing(o, d, [&](double t, double density) {
    if (!(t > 0 && t < far + clearance_)) return;
    const double close = t < nearest_ ? t * t / (nearest_ * nearest_) : 1.0;
    sum += density * close;
  });
  return sum > 0 ? sum * photometry_->candela(-d) : 0;
}

Vec3 OpeningHit::random_point(std::mt19937_64& random) const {
  const double u = static_cast<double>(random() >> 11) * 0x1p-53;
  return light_->position + light_->orientation * ((u - 0.5) * size_);
}

double OpeningHit::irradiance(const Vec3& from, const Vec3& x) const {
  const Vec3 way = x - from;
  return photometry_->candela(light_->orientation.transpose() * way) /
         std::max(way.squaredNorm(), nearest_ * nearest_);
}

}  // namespace reemit::hit_paths
