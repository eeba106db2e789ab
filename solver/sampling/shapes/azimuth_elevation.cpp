#include "solver/sampling/shapes/azimuth_elevation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/monotone_root.h"

namespace reemit {
namespace {

using std::numbers::pi;
constexpr std::size_t kCellsAcross = 12;
constexpr std::size_t kCellsAround = 16;
constexpr std::size_t kCellsSlim = 4;
/// Distance in radii from which a mantle counts as slim: what it sends varies little across it.
constexpr double kSlim = 2.5;
/// Share of the largest node that every node gets where the horizon cuts the region, so that what lies
/// between two nodes that see nothing is still drawn.
constexpr double kFloor = 1.0 / 128;

}  // namespace

AzimuthElevation::AzimuthElevation(const RoundRegion& region, const Vec3& axis, const Vec3& towards,
                                   const Vec3& n, bool cosine)
    : region_(region),
      axis_(axis),
      e1_(towards),
      e2_(axis.cross(towards)),
      n1_(n.dot(e1_)),
      n2_(n.dot(e2_)),
      n3_(n.dot(axis)),
      cosine_(cosine),
      around_(region.offset <= region.radius),
      slim_(region.kind == RoundRegion::Kind::kNearSide && region.offset > kSlim * region.radius) {
  cells_ = around_ ? kCellsAround : slim_ ? kCellsSlim : kCellsAcross;
  start_ = around_ ? -pi : slim_ ? -1 : -0.5 * pi;
  step_ = -2 * start_ / static_cast<double>(cells_);
  double c = around_ ? -1 : 0;
  double s = around_ ? 0 : -1;
  const double step_c = std::cos(step_);
  const double step_s = std::sin(step_);
  bool cut = false;
  double largest = 0;
  for (std::size_t i = 0; i <= cells_; ++i) {
    const Azimuth a = slim_ ? azimuth(start_ + static_cast<double>(i) * step_)
                            : azimuth(std::max(c, around_ ? -1.0 : 0.0), s);
    node_[i] = weight(a, span(a, cut)) * a.jacobian;
    if (!(node_[i] > 0)) node_[i] = 0;
    largest = std::max(largest, node_[i]);
    const double next_c = c * step_c - s * step_s;
    s = c * step_s + s * step_c;
    c = next_c;
  }
  if (!(largest > 0) || !std::isfinite(largest)) return;
  if (cut)
    for (std::size_t i = 0; i <= cells_; ++i) node_[i] += kFloor * largest;
  up_to_[0] = 0;
  for (std::size_t i = 0; i < cells_; ++i)
    up_to_[i + 1] = up_to_[i] + 0.5 * step_ * (node_[i] + node_[i + 1]);
  total_ = up_to_[cells_];
}

AzimuthElevation::Azimuth AzimuthElevation::azimuth(double parameter) const {
  if (slim_) return azimuth(std::sqrt(std::max(0.0, (1 - parameter) * (1 + parameter))), parameter);
  const double c = std::cos(parameter);
  return azimuth(around_ ? c : std::max(0.0, c), std::sin(parameter));
}

AzimuthElevation::Azimuth AzimuthElevation::azimuth(double pc, double ps) const {
  const double l = region_.offset;
  const double r = region_.radius;
  Azimuth a;
  if (around_) {
    a.c = pc;
    a.s = ps;
    a.jacobian = 1;
    a.near = 0;
    const double along = l * pc;
    const double half = std::sqrt(std::max(0.0, r * r - l * l * ps * ps));
    a.far = along > 0 ? along + half : (r - l) * (r + l) / std::max(half - along, 1e-300);
    return a;
  }
  // Sine of the azimuth r/l times that of the parameter: takes the square root out of the ends.
  a.s = r / l * ps;
  a.c = std::sqrt((l - r) * (l + r) + r * r * pc * pc) / l;
  a.jacobian = r / l * (slim_ ? 1 : pc) / a.c;
  a.far = l * a.c + r * pc;
  a.near = (l - r) * (l + r) / a.far;
  return a;
}

double AzimuthElevation::parameter_of(const Vec3& d) const {
  const double x = d.dot(e1_);
  const double y = d.dot(e2_);
  if (around_) return std::atan2(y, x);
  const double across = std::hypot(x, y);
  if (!(across > 0)) return 0;
  const double sine = std::clamp(region_.offset * y / (region_.radius * across), -1.0, 1.0);
  return slim_ ? sine : std::asin(sine);
}

AzimuthElevation::Span AzimuthElevation::span(const Azimuth& a, bool& cut) const {
  Span e;
  // Ends as (distance, height).
  double d0 = a.far;
  double z0 = region_.low;
  double d1 = a.near;
  double z1 = region_.low;
  switch (region_.kind) {
    case RoundRegion::Kind::kDisk:
      break;
    case RoundRegion::Kind::kNearSide:
      d0 = a.near;
      z1 = region_.high;
      break;
    case RoundRegion::Kind::kFarSide:
      d1 = a.far;
      z1 = region_.high;
      if (a.near > 0) {  // looks in over or under the edge of the near side
        if (region_.low > 0 && region_.low * a.far < region_.high * a.near) {
          d1 = a.near;
          z1 = region_.low;
        } else if (region_.high < 0 && region_.high * a.far > region_.low * a.near) {
          d0 = a.near;
          z0 = region_.high;
        } else if (region_.low <= 0 && region_.high >= 0) {
          return e;
        }
      }
      break;
  }
  const double l0 = std::sqrt(d0 * d0 + z0 * z0);
  const double l1 = std::sqrt(d1 * d1 + z1 * z1);
  if (!(l0 > 0 && l1 > 0)) return e;
  e.c0 = d0 / l0;
  e.s0 = z0 / l0;
  e.c1 = d1 / l1;
  e.s1 = z1 / l1;
  const double n_r = radial_part(a);
  const double up0 = n_r * e.c0 + n3_ * e.s0;
  const double up1 = n_r * e.c1 + n3_ * e.s1;
  if (up0 <= 0 || up1 <= 0) {
    cut = true;
    if (up0 <= 0 && up1 <= 0) return e;
    const double length = std::hypot(n_r, n3_);
    const double c = std::fabs(n3_) / length;
    const double s = n3_ > 0 ? -n_r / length : n_r / length;
    (up0 <= 0 ? e.c0 : e.c1) = c;
    (up0 <= 0 ? e.s0 : e.s1) = s;
  }
  e.empty = !(e.c0 * e.s1 - e.s0 * e.c1 > 0);
  if (e.empty && region_.kind == RoundRegion::Kind::kFarSide) cut = true;  // by the near side
  return e;
}

namespace {

/// s1 - s0, with the digits that the cosines have where both are near 1.
double sine_difference(double c0, double s0, double c1, double s1) {
  const double sum = s0 + s1;
  return std::fabs(sum) > 1 ? (c0 - c1) * (c0 + c1) / sum : s1 - s0;
}

}  // namespace

double AzimuthElevation::weight(const Azimuth& a, const Span& e) const {
  if (e.empty) return 0;
  if (!cosine_) return sine_difference(e.c0, e.s0, e.c1, e.s1);
  const double angle = std::atan2(e.c0 * e.s1 - e.s0 * e.c1, e.c0 * e.c1 + e.s0 * e.s1);
  return cosine_to(radial_part(a), e, e.c1, e.s1, angle);
}

/// Integral of (n_r cos e + n_z sin e) cos e from the start of the span over `angle`, to the elevation (c,
/// s).
double AzimuthElevation::cosine_to(double n_r, const Span& e, double c, double s, double angle) const {
  const double sines2 = std::fabs(s) > 0.7 ? (e.c0 - c) * (e.c0 + c) : (s - e.s0) * (s + e.s0);
  return 0.5 * (n_r * (angle + c * s - e.c0 * e.s0) + n3_ * sines2);
}

double AzimuthElevation::density(double parameter) const {
  const double t = std::clamp((parameter - start_) / step_, 0.0, static_cast<double>(cells_));
  const auto i = std::min(static_cast<std::size_t>(t), cells_ - 1);
  const double f = t - static_cast<double>(i);
  return (node_[i] + f * (node_[i + 1] - node_[i])) / total_;
}

AzimuthElevation::Direction AzimuthElevation::sample(double u0, double u1) const {
  const double target = u0 * total_;
  std::size_t i = 0;
  while (i + 1 < cells_ && target >= up_to_[i + 1]) ++i;
  const double v0 = node_[i];
  const double v1 = node_[i + 1];
  const double part = (target - up_to_[i]) / step_;
  const double root = v0 + std::sqrt(std::max(0.0, v0 * v0 + 2 * (v1 - v0) * part));
  const double f = root > 0 ? std::min(1.0, 2 * part / root) : 0.5;
  const double parameter = start_ + step_ * (static_cast<double>(i) + f);
  const double drawn = (v0 + f * (v1 - v0)) / total_;

  const Azimuth a = azimuth(parameter);
  bool cut = false;
  const Span e = span(a, cut);
  const double whole = weight(a, e);
  Direction result;
  if (!(whole > 0 && drawn > 0 && a.jacobian > 0)) {  // this azimuth has nothing above the horizon
    const double z =
        region_.kind == RoundRegion::Kind::kDisk ? region_.low : 0.5 * (region_.low + region_.high);
    const Vec3 to = a.far * (a.c * e1_ + a.s * e2_) + z * axis_;
    return {to.normalized(), a.far, 0, 0};
  }
  const double n_r = radial_part(a);
  double c = 0;
  double s = 0;
  if (cosine_) {
    const double angle = std::atan2(e.c0 * e.s1 - e.s0 * e.c1, e.c0 * e.c1 + e.s0 * e.s1);
    const auto at = [&](double t) {
      const double ct = std::cos(t);
      const double st = std::sin(t);
      const double ce = e.c0 * ct - e.s0 * st;
      const double se = e.s0 * ct + e.c0 * st;
      return ValueAndSlope{cosine_to(n_r, e, ce, se, t), ce * (n_r * ce + n3_ * se)};
    };
    const double t = monotone_root(at, u1 * whole, whole, angle, e.c0 * (n_r * e.c0 + n3_ * e.s0),
                                   e.c1 * (n_r * e.c1 + n3_ * e.s1));
    const double ct = std::cos(t);
    const double st = std::sin(t);
    c = std::max(0.0, e.c0 * ct - e.s0 * st);
    s = e.s0 * ct + e.c0 * st;
  } else if (e.s0 + e.s1 >= 0) {
    // Uniform in the sine, as 1 - sine: it keeps its digits near the axis.
    const double below0 = e.s0 > 0 ? e.c0 * e.c0 / (1 + e.s0) : 1 - e.s0;
    const double below = below0 - u1 * whole;
    s = 1 - below;
    c = std::sqrt(std::max(0.0, below * (2 - below)));
  } else {
    const double above0 = e.s0 < 0 ? e.c0 * e.c0 / (1 - e.s0) : 1 + e.s0;
    const double above = above0 + u1 * whole;
    s = above - 1;
    c = std::sqrt(std::max(0.0, above * (2 - above)));
  }
  result.unit = c * (a.c * e1_ + a.s * e2_) + s * axis_;
  const double up = std::max(0.0, n_r * c + n3_ * s);
  if (cosine_) {
    result.irradiance = whole * a.jacobian / drawn;
    result.pdf_per_sr = up / result.irradiance;
  } else {
    result.pdf_per_sr = drawn / (a.jacobian * whole);
    result.irradiance = up / result.pdf_per_sr;
  }
  switch (region_.kind) {
    case RoundRegion::Kind::kDisk:
      result.distance = s > 0 ? std::min(a.far, region_.low * c / s) : a.far;
      break;
    case RoundRegion::Kind::kNearSide:
      result.distance = a.near;
      break;
    case RoundRegion::Kind::kFarSide:
      result.distance = a.far;
      break;
  }
  return result;
}

double AzimuthElevation::pdf_per_sr(const Vec3& d) const {
  const double parameter = parameter_of(d);
  const Azimuth a = azimuth(parameter);
  bool cut = false;
  const Span e = span(a, cut);
  const double whole = weight(a, e);
  const double s = d.dot(axis_);
  const double c = std::hypot(d.dot(e1_), d.dot(e2_));
  const double up = radial_part(a) * c + n3_ * s;
  constexpr double kSlack = 1e-9;
  if (!(whole > 0) || up < 0 || e.c0 * s - e.s0 * c < -kSlack || e.s1 * c - e.c1 * s < -kSlack) return 0;
  const double base = density(parameter) / (a.jacobian * whole);
  return cosine_ ? base * up : base;
}

std::array<double, 2> AzimuthElevation::invert(const Vec3& d) const {
  const double parameter = parameter_of(d);
  const double t = std::clamp((parameter - start_) / step_, 0.0, static_cast<double>(cells_));
  const auto i = std::min(static_cast<std::size_t>(t), cells_ - 1);
  const double f = t - static_cast<double>(i);
  const double u0 = (up_to_[i] + step_ * f * (node_[i] + 0.5 * f * (node_[i + 1] - node_[i]))) / total_;

  const Azimuth a = azimuth(parameter);
  bool cut = false;
  const Span e = span(a, cut);
  const double whole = weight(a, e);
  if (!(whole > 0)) return {u0, 0.5};
  const double s = d.dot(axis_);
  const double c = std::hypot(d.dot(e1_), d.dot(e2_));
  const double part =
      cosine_ ? cosine_to(radial_part(a), e, c, s, std::atan2(e.c0 * s - e.s0 * c, e.c0 * c + e.s0 * s))
              : sine_difference(e.c0, e.s0, c, s);
  return {std::clamp(u0, 0.0, 1.0), std::clamp(part / whole, 0.0, 1.0)};
}

}  // namespace reemit
