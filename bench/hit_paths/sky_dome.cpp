#include "bench/hit_paths/sky_dome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace reemit::hit_paths {

using std::numbers::pi;

SkyDome::SkyDome(const Scene& scene) : sky_(scene.sky ? &*scene.sky : nullptr) {
  if (sky_ == nullptr) return;
  zenith_ = Spectrum::Zero(static_cast<Eigen::Index>(scene.bands.count()));
  if (sky_->ground_reflectance.size() > 0) ground_ = ground_radiance(*sky_, scene.bands);
  if (sky_->kind == SkyKind::kImage || sky_->kind == SkyKind::kNone) return;
  // Midpoints of squares of a quarter of a degree.
  constexpr int kSteps = 360;
  const double step = 0.5 * pi / kSteps;
  double horizontal = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double altitude = (i + 0.5) * step;
      horizontal += relative(sky_->towards(altitude, (j + 0.5) * step)) * std::sin(altitude) *
                    std::cos(altitude) * step * step;
    }
  zenith_ = horizontal_sky_irradiance(*sky_, scene.bands) / horizontal;
}

double SkyDome::relative(const Vec3& direction) const {
  const double height = direction.dot(sky_->up);
  if (sky_->kind == SkyKind::kUniform) return 1;
  if (sky_->kind == SkyKind::kOvercast) return (1 + 2 * height) / 3;
  const double to_sun = sky_->sun ? std::acos(std::clamp(direction.dot(sky_->towards_sun()), -1.0, 1.0)) : 0;
  return sky_->gradation.relative_luminance(height, to_sun);
}

void SkyDome::add_radiance(const Vec3& direction, const Spectrum& weight, double* sum) const {
  if (sky_ == nullptr) return;
  const double height = direction.dot(sky_->up);
  const bool below = height < 0 && ground_.size() > 0;
  if (sky_->kind == SkyKind::kImage && !below) {
    const SkyImage& image = *sky_->image;
    const double azimuth = std::atan2(direction.dot(sky_->north.cross(sky_->up)), direction.dot(sky_->north));
    const auto pick = [](double share, std::size_t count) {
      return std::min(static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(count))), count - 1);
    };
    const float* pixel =
        image.pixel(pick(std::acos(std::clamp(height, -1.0, 1.0)) / pi, image.rows),
                    pick(azimuth / (2 * pi) + 0.5, image.columns), static_cast<std::size_t>(weight.size()));
    for (Eigen::Index b = 0; b < weight.size(); ++b) sum[b] += weight[b] * static_cast<double>(pixel[b]);
    return;
  }
  if (height < 0 && !below) return;
  const Spectrum radiance = below ? ground_ : Spectrum(relative(direction) * zenith_);
  for (Eigen::Index b = 0; b < weight.size(); ++b) sum[b] += weight[b] * radiance[b];
}

Vec3 SkyDome::towards_sun(PathRandom& random) const {
  const double least = std::cos(sky_->sun->half_angle);
  return direction_about(sky_->towards_sun(), least + (1 - least) * uniform(random), random);
}

Spectrum SkyDome::sun_irradiance() const {
  return sky_->sun->irradiance;
}

}  // namespace reemit::hit_paths
