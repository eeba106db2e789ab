#include "solver/sampling/shapes/polygon_sampler.h"

#include <algorithm>
#include <cmath>

namespace reemit {

ConvexPolygonSampler::ConvexPolygonSampler(std::span<const Vec3> corners, const Vec3& front, const Vec3& x,
                                           const Vec3& n, Density density)
    : x_(x), n_(n), front_(front), density_(density) {
  if (corners.size() < 3 || corners.size() > kMostCorners) return;
  height_ = front.dot(x - corners[0]);
  if (!(height_ > 0)) return;
  double highest = 0;
  double size2 = 0;
  double nearest2 = (corners[0] - x).squaredNorm();
  for (const Vec3& p : corners) {
    highest = std::max(highest, n.dot(p - x));
    size2 = std::max(size2, (p - corners[0]).squaredNorm());
    nearest2 = std::min(nearest2, (p - x).squaredNorm());
  }
  if (!(highest > 0)) return;
  if (density != Density::kArea && nearest2 > kFarSizes * kFarSizes * size2) density_ = Density::kVisibleArea;
  if (density_ == Density::kArea) {
    set_up_area(corners);
    return;
  }
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  constexpr double kLine = 1e-13;
  if (!(normal.squaredNorm() > kLine * kLine * size2 * size2)) return;
  const ClippedPolygon clipped(corners, x, n);
  if (density_ == Density::kSolidAngle) {
    fan_.emplace(clipped);
    extent_ = fan_->solid_angle();
  } else if (density_ == Density::kCosine) {
    projection_.emplace(clipped, n);
    extent_ = projection_->projected_solid_angle();
  }
  lights_ = extent_ > 0;
  if (lights_) return;
  // Drawn from by area on purpose, or because it is too narrow for the rounding of the others.
  density_ = Density::kVisibleArea;
  std::array<Vec3, kMostCorners + 1> visible;
  for (std::size_t i = 0; i < clipped.count; ++i) visible[i] = clipped.corner[i] + x;
  set_up_area(std::span<const Vec3>(visible.data(), clipped.count));
}

void ConvexPolygonSampler::set_up_area(std::span<const Vec3> corners) {
  count_ = corners.size();
  if (count_ < 3) return;
  for (std::size_t i = 0; i < count_; ++i) corner_[i] = corners[i];
  area_to_[1] = 0;
  for (std::size_t i = 1; i + 1 < count_; ++i) {
    extent_ += 0.5 * (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]).norm();
    area_to_[i + 1] = extent_;
  }
  lights_ = extent_ > 0;
}

Vec3 ConvexPolygonSampler::on_plane(const Vec3& direction) const {
  const double towards = -front_.dot(direction);
  return x_ + (towards > 0 ? height_ / towards : 0.0) * direction;
}

ShapePoint ConvexPolygonSampler::sample(double u0, double u1) const {
  if (!lights_) return {};
  if (density_ == Density::kSolidAngle) {
    const Vec3 direction = fan_->sample(u0, u1);
    return direction_point(on_plane(direction), front_, direction, 1 / extent_,
                           std::max(0.0, n_.dot(direction)) * extent_);
  }
  if (density_ == Density::kCosine) {
    const Vec3 direction = projection_->sample(u0, u1);
    return direction_point(on_plane(direction), front_, direction, std::max(0.0, n_.dot(direction)) / extent_,
                           extent_);
  }
  const double target = u0 * extent_;
  std::size_t i = 1;
  while (i + 2 < count_ && target >= area_to_[i + 1]) ++i;
  const double width = area_to_[i + 1] - area_to_[i];
  const double along = width > 0 ? (target - area_to_[i]) / width : 0.5;
  // Uniform in a triangle [TUR90], radially from the first corner.
  const Vec3 edge = corner_[i] + along * (corner_[i + 1] - corner_[i]);
  return area_point(corner_[0] + std::sqrt(u1) * (edge - corner_[0]), front_, extent_, x_, n_);
}

double ConvexPolygonSampler::pdf_per_sr(const Vec3& point) const {
  if (!lights_) return 0;
  const double up = n_.dot(point - x_);
  switch (density_) {
    case Density::kArea:
      return area_pdf_per_sr(point, front_, extent_, x_);
    case Density::kVisibleArea:
      return up >= 0 ? area_pdf_per_sr(point, front_, extent_, x_) : 0.0;
    case Density::kSolidAngle:
      return up >= 0 ? 1 / extent_ : 0.0;
    case Density::kCosine:
      return up > 0 ? up / ((point - x_).norm() * extent_) : 0.0;
  }
  return 0;
}

std::array<double, 2> ConvexPolygonSampler::invert(const Vec3& point) const {
  if (!lights_) return {0.5, 0.5};
  if (density_ == Density::kSolidAngle) return fan_->invert((point - x_).normalized());
  if (density_ == Density::kCosine) return projection_->invert((point - x_).normalized());
  const Vec3 p = point - corner_[0];
  for (std::size_t i = 1; i + 1 < count_; ++i) {
    const Vec3 a = corner_[i] - corner_[0];
    const Vec3 b = corner_[i + 1] - corner_[0];
    const Vec3 normal = a.cross(b);
    const double area2 = normal.squaredNorm();
    if (!(area2 > 0)) continue;
    const double va = p.cross(b).dot(normal) / area2;
    const double vb = a.cross(p).dot(normal) / area2;
    if ((va < 0 || vb < 0) && i + 2 < count_ && vb > 0) continue;
    const double sum = va + vb;
    const double along = sum > 0 ? std::clamp(vb / sum, 0.0, 1.0) : 0.5;
    return {(area_to_[i] + along * (area_to_[i + 1] - area_to_[i])) / extent_,
            std::clamp(sum * sum, 0.0, 1.0)};
  }
  return {0.5, 0.5};
}

double ConvexPolygonSampler::irradiance() const {
  if (!lights_) return 0;
  if (density_ == Density::kCosine) return extent_;
  if (density_ == Density::kSolidAngle) return lambert_irradiance(fan_->corners(), n_);
  std::array<Vec3, kMostCorners + 1> relative;
  for (std::size_t i = 0; i < count_; ++i) relative[i] = corner_[i] - x_;
  const std::span<const Vec3> corners(relative.data(), count_);
  if (density_ == Density::kVisibleArea) return lambert_irradiance(corners, n_);
  return lambert_irradiance(ClippedPolygon(corners, Vec3::Zero(), n_).corners(), n_);
}

}  // namespace reemit
