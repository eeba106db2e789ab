#include "solver/sky/sun_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "solver/sampling/warp.h"

namespace reemit {

SunBeam::SunBeam(const Vec3& towards, double half_angle, const SkyBox& box)
    : axis_(towards), sin_(std::sin(half_angle)), cos_(std::cos(half_angle)) {
  solid_angle_ = 2 * std::numbers::pi * (1 - cos_);
  // Along the axes of the box as far as can be, so that the rectangle is small.
  const Vec3 up = box.axes.row(2).transpose();
  const Vec3 across = axis_.cross(up);
  tangent_ = across.norm() > 1e-3 ? Vec3(across.normalized()) : Vec3(box.axes.row(0).transpose());
  bitangent_ = axis_.cross(tangent_).normalized();
  tangent_ = bitangent_.cross(axis_);
  const Vec3 size = box.high;  // the box is about the origin
  const auto reach = [&](const Vec3& v) { return (box.axes * v).cwiseAbs().dot(size); };
  distance_ = 1.001 * reach(axis_);
  const double spread = 2 * distance_ * std::tan(half_angle);
  half_x_ = reach(tangent_) + spread;
  half_y_ = reach(bitangent_) + spread;
}

Vec3 SunBeam::sample(double u0, double u1) const {
  const Point2 d = sample_disk(static_cast<float>(u0), static_cast<float>(u1));
  const double x = sin_ * static_cast<double>(d.x);
  const double y = sin_ * static_cast<double>(d.y);
  return x * tangent_ + y * bitangent_ + std::sqrt(std::max(0.0, 1 - x * x - y * y)) * axis_;
}

SkyRay SunBeam::start(const Numbers& u) const {
  const Vec3 towards = sample(u[2], u[3]);
  const Vec3 point =
      distance_ * axis_ + (2 * u[0] - 1) * half_x_ * tangent_ + (2 * u[1] - 1) * half_y_ * bitangent_;
  return {point.cast<float>(), (-towards).cast<float>()};
}

void SunBeam::invert(const Vec3& point, const Vec3& towards, Numbers& u) const {
  const Vec3 at = point + (distance_ - point.dot(axis_)) / towards.dot(axis_) * towards;
  u[0] = 0.5 * (at.dot(tangent_) / half_x_ + 1);
  u[1] = 0.5 * (at.dot(bitangent_) / half_y_ + 1);
  const std::array<float, 2> disk = invert_disk(
      {static_cast<float>(towards.dot(tangent_) / sin_), static_cast<float>(towards.dot(bitangent_) / sin_)});
  u[2] = static_cast<double>(disk[0]);
  u[3] = static_cast<double>(disk[1]);
  for (double& number : u) number = std::clamp(number, 0.0, double{kLargestBelowOne});
}

}  // namespace reemit
