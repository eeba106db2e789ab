#include "solver/sampling/shapes/cylinder_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {
namespace {

using std::numbers::pi;

}  // namespace

CylinderSampler::CylinderSampler(const Cylinder& cylinder, const Vec3& x, const Vec3& n, Density density)
    : cylinder_(cylinder), x_(x), n_(n), density_(density) {
  const Vec3 along = cylinder.top - cylinder.base;
  length_ = along.norm();
  if (!(length_ > 0) || !(cylinder.radius > 0)) return;
  axis_ = along / length_;
  const Vec3 to_base = cylinder.base - x;
  const AlignedFrame frame(axis_, to_base);
  towards_ = frame.e1;
  across_ = frame.e2;
  offset_ = frame.across;
  low_ = frame.along;
  const double high = low_ + length_;
  const bool inside = offset_ <= cylinder.radius;
  if (inside && !cylinder.inward) return;
  if (cylinder.inward && !inside && low_ <= 0 && high >= 0) return;
  // Highest point of the mantle above the horizon.
  const double tilt = n.dot(axis_);
  const double reach = cylinder.radius * std::sqrt(std::max(0.0, 1 - tilt * tilt));
  if (!(n.dot(to_base) + std::max(0.0, tilt * length_) + reach > 0)) return;
  lights_ = true;

  const double size = std::max(length_, 2 * cylinder.radius);
  const double beside = std::max({0.0, low_, -high});
  if (density != Density::kArea &&
      beside * beside + offset_ * offset_ > kFarCylinder * kFarCylinder * size * size)
    density_ = Density::kVisibleArea;
  if (density_ == Density::kSolidAngle || density_ == Density::kCosine) {
    const RoundRegion region{cylinder.inward ? RoundRegion::Kind::kFarSide : RoundRegion::Kind::kNearSide,
                             offset_, cylinder.radius, low_, high};
    angles_.emplace(region, axis_, towards_, n, density_ == Density::kCosine);
    if (angles_->total() > 0) return;
    angles_.reset();
    density_ = Density::kVisibleArea;
  }
  half_ = pi;
  if (density_ == Density::kVisibleArea && !inside) {
    const double turned = std::acos(std::min(1.0, cylinder.radius / offset_));
    middle_ = cylinder.inward ? 0 : pi;
    half_ = cylinder.inward ? pi - turned : turned;
  }
  area_ = 2 * half_ * cylinder.radius * length_;
}

Vec3 CylinderSampler::outward(const Vec3& point) const {
  const Vec3 p = point - cylinder_.base;
  return (p - axis_.dot(p) * axis_).normalized();
}

bool CylinderSampler::hidden(const Vec3& point) const {
  if (!cylinder_.inward || offset_ <= cylinder_.radius) return false;
  const Vec3 to = point - x_;
  const double z = axis_.dot(to);
  const double far = std::hypot(to.dot(towards_), to.dot(across_));
  const double near = (offset_ - cylinder_.radius) * (offset_ + cylinder_.radius) / far;
  const double crossing = z * near / far;
  return crossing > low_ && crossing < low_ + length_;
}

ShapePoint CylinderSampler::sample(double u0, double u1) const {
  if (!lights_) return {};
  const double side = cylinder_.inward ? -1 : 1;
  if (!angles_) {
    const double azimuth = middle_ + (2 * u0 - 1) * half_;
    const Vec3 out = std::cos(azimuth) * towards_ + std::sin(azimuth) * across_;
    const Vec3 point = cylinder_.base + (u1 * length_) * axis_ + cylinder_.radius * out;
    ShapePoint s = area_point(point, side * out, area_, x_, n_);
    if (hidden(point)) s.irradiance = 0;
    return s;
  }
  const AzimuthElevation::Direction d = angles_->sample(u0, u1);
  // Radially in two dimensions about x, which keeps the digits of the cross-section.
  const double a = d.unit.dot(towards_);
  const double b = d.unit.dot(across_);
  const double c = std::hypot(a, b);
  if (!(c > 0)) return {};
  const Vec3 out = ((d.distance * a / c - offset_) * towards_ + (d.distance * b / c) * across_).normalized();
  const double z = std::clamp(d.distance * axis_.dot(d.unit) / c - low_, 0.0, length_);
  const Vec3 point = cylinder_.base + z * axis_ + cylinder_.radius * out;
  return direction_point(point, side * out, d.unit, d.pdf_per_sr, d.irradiance);
}

double CylinderSampler::pdf_per_sr(const Vec3& point) const {
  if (!lights_) return 0;
  const Vec3 normal = (cylinder_.inward ? -1.0 : 1.0) * outward(point);
  if (!(normal.dot(x_ - point) > 0)) return 0;
  if (!angles_) return area_pdf_per_sr(point, normal, area_, x_);
  if (hidden(point)) return 0;
  return angles_->pdf_per_sr((point - x_).normalized());
}

std::array<double, 2> CylinderSampler::invert(const Vec3& point) const {
  if (!lights_) return {0.5, 0.5};
  if (angles_) return angles_->invert((point - x_).normalized());
  const Vec3 out = outward(point);
  const double turn = std::cos(middle_);  // middle is 0 or pi
  const double azimuth = std::atan2(turn * out.dot(across_), turn * out.dot(towards_));
  return {std::clamp(0.5 * (1 + azimuth / half_), 0.0, 1.0),
          std::clamp(axis_.dot(point - cylinder_.base) / length_, 0.0, 1.0)};
}

}  // namespace reemit
