#include "solver/sampling/shapes/sphere_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {

SphereSampler::SphereSampler(const Sphere& sphere, const Vec3& x, const Vec3& n, Density density,
                             bool is_clear)
    : centre_(sphere.centre),
      x_(x),
      n_(n),
      to_centre_(sphere.centre - x),
      radius_(sphere.radius),
      distance_(to_centre_.norm()),
      side_(sphere.inward ? -1 : 1),
      inside_(distance_ <= radius_),
      density_(density) {
  constexpr double kPi = std::numbers::pi;
  const double height = n.dot(to_centre_);
  const bool can_light = inside_ ? sphere.inward : !sphere.inward || is_clear;
  if (!(radius_ > 0) || !can_light || !(height + radius_ > 0)) return;
  if (density == Density::kArea || (sphere.inward && density == Density::kVisibleArea)) {
    region_ = Region::kWholeArea;
    extent_ = 4 * kPi * radius_ * radius_;
    e3_ = {0, 0, 1};
    e1_ = {1, 0, 0};
    e2_ = {0, 1, 0};
    return;
  }
  if (inside_) {
    region_ = density == Density::kCosine ? Region::kProjectedHemisphere : Region::kHemisphere;
    extent_ = density == Density::kCosine ? kPi : 2 * kPi;
    cap_height_ = 1;
    e3_ = n;
    const Tangents tangents(e3_);
    e1_ = tangents.t;
    e2_ = tangents.b;
    return;
  }
  const double gap = distance_ - radius_;
  const double sin_alpha = radius_ / distance_;
  const double cos_alpha = std::sqrt(gap * (distance_ + radius_)) / distance_;
  if (density == Density::kCosine) {
    e3_ = n;
    const AlignedFrame frame(n, to_centre_ / distance_);
    e1_ = frame.e1;
    e2_ = frame.e2;
    cap_ = ProjectedCap(sin_alpha, cos_alpha, frame.across, frame.along);
    extent_ = cap_.projected_solid_angle();
    if (extent_ > 0) {
      region_ = Region::kProjectedCap;
      return;
    }
    density_ = Density::kSolidAngle;  // a sliver above the horizon too thin for rounding
  }
  e3_ = to_centre_ / distance_;
  if (density == Density::kVisibleArea) {
    region_ = Region::kCapArea;
    e3_ = -e3_;
    cap_height_ = gap / distance_;
    extent_ = 2 * kPi * radius_ * radius_ * cap_height_;
  } else {
    region_ = Region::kCone;
    cap_height_ = sin_alpha * sin_alpha / (1 + cos_alpha);
    extent_ = 2 * kPi * cap_height_;
  }
  const Tangents tangents(e3_);
  e1_ = tangents.t;
  e2_ = tangents.b;
}

Vec3 SphereSampler::hit(const Vec3& direction) const {
  const double along = to_centre_.dot(direction);
  const double half_chord =
      std::sqrt(std::max(0.0, radius_ * radius_ - to_centre_.cross(direction).squaredNorm()));
  const double t =
      side_ < 0 ? along + half_chord : (distance_ - radius_) * (distance_ + radius_) / (along + half_chord);
  const Vec3 from_centre = t * direction - to_centre_;
  const double length = from_centre.norm();
  return length > 0 ? Vec3(from_centre * (radius_ / length)) : Vec3(-radius_ * direction);
}

ShapePoint SphereSampler::sample(double u0, double u1) const {
  Vec3 direction = n_;
  double irradiance = 0;
  double pdf = 0;
  switch (region_) {
    case Region::kNone:
      return {};
    case Region::kWholeArea:
    case Region::kCapArea: {
      const Vec3 outward = to_world(unit_cap(u0, u1, cap_height_));
      return area_point(centre_ + radius_ * outward, side_ * outward, extent_, x_, n_);
    }
    case Region::kCone:
    case Region::kHemisphere:
      direction = to_world(unit_cap(u0, u1, cap_height_));
      pdf = 1 / extent_;
      irradiance = std::max(0.0, n_.dot(direction)) * extent_;
      break;
    case Region::kProjectedHemisphere: {
      const auto d = unit_disk(u0, u1);
      const double z = std::sqrt(std::max(0.0, 1 - d[0] * d[0] - d[1] * d[1]));
      direction = to_world({d[0], d[1], z});
      pdf = z / extent_;
      irradiance = extent_;
      break;
    }
    case Region::kProjectedCap: {
      const Vec3 local = cap_.sample(u0, u1);
      direction = to_world(local);
      pdf = local.z() / extent_;
      irradiance = extent_;
      break;
    }
  }
  const Vec3 from_centre = hit(direction);
  return direction_point(centre_ + from_centre, (side_ / radius_) * from_centre, direction, pdf, irradiance);
}

double SphereSampler::pdf_per_sr(const Vec3& point) const {
  if (region_ == Region::kNone) return 0;
  const Vec3 normal = side_ * (point - centre_).normalized();
  if (!(normal.dot(x_ - point) > 0)) return 0;
  const double cos_theta = n_.dot(point - x_) / (point - x_).norm();
  switch (region_) {
    case Region::kNone:
      return 0;
    case Region::kWholeArea:
    case Region::kCapArea:
      return area_pdf_per_sr(point, normal, extent_, x_);
    case Region::kCone:
      return 1 / extent_;
    case Region::kHemisphere:
      return cos_theta > 0 ? 1 / extent_ : 0.0;
    case Region::kProjectedHemisphere:
    case Region::kProjectedCap:
      return std::max(0.0, cos_theta) / extent_;
  }
  return 0;
}

std::array<double, 2> SphereSampler::invert(const Vec3& point) const {
  switch (region_) {
    case Region::kNone:
      return {0.5, 0.5};
    case Region::kWholeArea:
    case Region::kCapArea:
      return invert_unit_cap(to_local((point - centre_).normalized()), cap_height_);
    case Region::kCone:
    case Region::kHemisphere:
      return invert_unit_cap(to_local((point - x_).normalized()), cap_height_);
    case Region::kProjectedHemisphere: {
      const Vec3 local = to_local((point - x_).normalized());
      return invert_unit_disk(local.x(), local.y());
    }
    case Region::kProjectedCap:
      return cap_.invert(to_local((point - x_).normalized()));
  }
  return {0.5, 0.5};
}

double SphereSampler::irradiance() const {
  if (region_ == Region::kNone) return 0;
  if (inside_) return std::numbers::pi;
  if (region_ == Region::kProjectedCap) return extent_;
  const AlignedFrame frame(n_, to_centre_ / distance_);
  const double sin_alpha = radius_ / distance_;
  const double cos_alpha = std::sqrt((distance_ - radius_) * (distance_ + radius_)) / distance_;
  return ProjectedCap(sin_alpha, cos_alpha, frame.across, frame.along).projected_solid_angle();
}

}  // namespace reemit
