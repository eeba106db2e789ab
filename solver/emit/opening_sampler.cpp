#include "solver/emit/opening_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

using std::numbers::pi;

/// Picks the part of [0,1) that holds u, by weights, and stretches that part to [0,1).
template <std::size_t N>
std::size_t pick(const std::array<double, N>& weights, double& u) {
  double total = 0;
  for (const double w : weights) total += w;
  double x = u * total;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < N; ++i) {
    if (!(weights[i] > 0)) continue;
    chosen = i;
    if (x < weights[i]) break;
    if (i + 1 < N) x -= weights[i];
  }
  u = std::clamp(x / weights[chosen], 0.0, 1.0);
  return chosen;
}

Vec3 sample_box(const Vec3& size, double u0, double u1) {
  // Areas of the faces across each axis.
  const std::array<double, 3> area{size.y() * size.z(), size.x() * size.z(), size.x() * size.y()};
  Vec3 p = Vec3::Zero();
  const std::size_t face = pick<6>({area[0], area[0], area[1], area[1], area[2], area[2]}, u0);
  const int across = static_cast<int>(face / 2);
  p[across] = face % 2 == 0 ? -0.5 * size[across] : 0.5 * size[across];
  const int a = (across + 1) % 3;
  const int b = (across + 2) % 3;
  p[a] = (u0 - 0.5) * size[a];
  p[b] = (u1 - 0.5) * size[b];
  return p;
}

Vec3 sample_cylinder(const Vec3& size, int axis, double u0, double u1) {
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  const double ra = 0.5 * size[a];
  const double rb = 0.5 * size[b];
  const double cap = pi * ra * rb;
  // Perimeter of an ellipse after Ramanujan; exact for circles. It only shares points between side and caps.
  const double perimeter = pi * (3 * (ra + rb) - std::sqrt((3 * ra + rb) * (ra + 3 * rb)));
  const double side = size[axis] * perimeter;
  Vec3 p = Vec3::Zero();
  if (!(cap + side > 0)) return (u0 - 0.5) * size;
  const std::size_t part = size[axis] > 0 ? pick<3>({side, cap, cap}, u0) : 1;
  if (part == 0) {
    const double phi = 2 * pi * u1;
    p[axis] = (u0 - 0.5) * size[axis];
    p[a] = ra * std::cos(phi);
    p[b] = rb * std::sin(phi);
  } else {
    const Point2 d = sample_disk(static_cast<float>(u0), static_cast<float>(u1));
    p[axis] = part == 1 ? -0.5 * size[axis] : 0.5 * size[axis];
    p[a] = ra * static_cast<double>(d.x);
    p[b] = rb * static_cast<double>(d.y);
  }
  return p;
}

}  // namespace

std::optional<FlatOpening> flat_opening(const LuminousOpening& opening) {
  if (opening.shape == LuminousOpening::Shape::kPoint) return FlatOpening{Vec3::Zero(), Vec3::Zero()};
  if (opening.shape != LuminousOpening::Shape::kBox) return std::nullopt;
  const Vec3 size = opening.size();
  const auto flat_sides = (size.array() <= 0).count();
  if (flat_sides >= 2) return FlatOpening{size, Vec3::Zero()};
  if (flat_sides == 0) return std::nullopt;
  int across = 0;
  size.minCoeff(&across);
  const int a = (across + 1) % 3;
  const int b = (across + 2) % 3;
  return FlatOpening{size[a] * Vec3::Unit(a), size[b] * Vec3::Unit(b)};
}

Vec3 sample_opening(const LuminousOpening& opening, double u0, double u1) {
  if (const auto flat = flat_opening(opening)) return flat->point(u0, u1);
  const Vec3 size = opening.size();
  switch (opening.shape) {
    case LuminousOpening::Shape::kPoint:
      break;
    case LuminousOpening::Shape::kBox:
      return sample_box(size, u0, u1);
    case LuminousOpening::Shape::kCylinder:
      return sample_cylinder(size, static_cast<int>(opening.axis), u0, u1);
    case LuminousOpening::Shape::kEllipsoid:
      return 0.5 *
             size.cwiseProduct(sample_sphere(static_cast<float>(u0), static_cast<float>(u1)).cast<double>());
  }
  return Vec3::Zero();
}

double opening_extent(const LuminousOpening& opening) {
  return opening.shape == LuminousOpening::Shape::kPoint ? 0 : opening.size().maxCoeff();
}

}  // namespace reemit
