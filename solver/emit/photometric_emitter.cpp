#include "solver/emit/photometric_emitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/model/opening_reach.h"
#include "solver/emit/intensity_sampler.h"
#include "solver/emit/opening_sampler.h"

namespace reemit {

PhotometricEmitter::PhotometricEmitter(const PhotometricLight& light, const RayScene& rays)
    : table_(light.table),
      opening_(light.opening),
      centre_(rays.normalised(light.position).cast<double>()),
      to_room_(light.orientation),
      metres_(rays.metres_per_unit()) {
  const double extent = opening_extent(opening_) / metres_;
  extent2_ = extent * extent;
  nearest2_ = kNearest * kNearest * extent2_;
}

Vec3 PhotometricEmitter::point(double u0, double u1) const {
  return centre_ + to_room_ * sample_opening(opening_, u0, u1) / metres_;
}

// I cos / r^2 for a point of the opening [cd/m2].
double PhotometricEmitter::kernel(const Vec3& to_light, const Vec3& n) const {
  const double height = n.dot(to_light);
  const double distance2 = to_light.squaredNorm();
  if (!(height > 0) || !(distance2 > 0)) return 0;
  const double intensity = table_->intensity(to_room_.transpose() * -to_light);
  return intensity * height / (std::sqrt(distance2) * std::max(distance2, nearest2_) * metres_ * metres_);
}

float PhotometricEmitter::expected_irradiance(const Vec3f& x, const Vec3f& n) const {
  const Vec3 from = x.cast<double>();
  const Vec3 normal = n.cast<double>();
  const Vec3 to_centre = centre_ - from;
  if (!(extent2_ > 0)) return static_cast<float>(kernel(to_centre, normal));
  const double height =
      normal.dot(to_centre) + opening_reach(opening_, to_room_.transpose() * normal) / metres_;
  if (!(height > 0)) return 0;
  // Beyond five sizes the centre stands for the rest to about 1 % ([ZIM98] appendix, the five-times rule).
  constexpr double kFar2 = 25;
  const double distance2 = to_centre.squaredNorm();
  double mean = 0;
  if (distance2 > kFar2 * extent2_) {
    mean = kernel(to_centre, normal);
  } else {
    constexpr std::array<std::array<double, 2>, 4> kPoints{{{0.2, 0.3}, {0.7, 0.2}, {0.3, 0.8}, {0.8, 0.7}}};
    for (const auto& [u0, u1] : kPoints) mean += 0.25 * kernel(point(u0, u1) - from, normal);
  }
  // What these points miss must keep a weight.
  constexpr double kLeastShare = 1e-3;
  const double around = table_->total_flux() / (4 * std::numbers::pi * metres_ * metres_);
  const double least = kLeastShare * around * height / std::pow(distance2 + extent2_, 1.5);
  return static_cast<float>(std::max(mean, least));
}

PunctualSample PhotometricEmitter::sample(const Vec3f& x, const Vec3f& n, float u0, float u1) const {
  const Vec3 from = x.cast<double>();
  const Vec3 p = point(static_cast<double>(u0), static_cast<double>(u1));
  const Vec3 to_light = p - from;
  PunctualSample result;
  result.factor = static_cast<float>(kernel(to_light, n.cast<double>()));
  if (!(result.factor > 0)) return result;
  const double distance = to_light.norm();
  result.target = (p - std::min(0.5, kClear / distance) * to_light).cast<float>();
  return result;
}

void start_photometric_ray(const PhotometricLight& light, const RayScene& rays, float u0, float u1, float u2,
                           float u3, Vec3f& origin, Vec3f& direction) {
  const Vec3 away =
      light.orientation * sample_intensity(*light.table, static_cast<double>(u2), static_cast<double>(u3));
  const Vec3 from = rays.normalised(light.position).cast<double>() +
                    light.orientation *
                        sample_opening(light.opening, static_cast<double>(u0), static_cast<double>(u1)) /
                        rays.metres_per_unit();
  origin = (from + PhotometricEmitter::kClear * away).cast<float>();
  direction = away.cast<float>().normalized();
}

}  // namespace reemit
