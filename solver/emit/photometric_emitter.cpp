#include "solver/emit/photometric_emitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scenes/model/opening_reach.h"
#include "solver/emit/intensity_sampler.h"

namespace reemit {
namespace {

/// Mean direction of the light, or the nadir where it goes to all sides alike; luminaire coordinates.
Vec3 main_direction(const IntensityTable& table) {
  constexpr int kSteps = 64;
  constexpr double kAllSidesAlike = 0.02;
  Vec3 sum = Vec3::Zero();
  double total = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 2 * kSteps; ++j) {
      const double z = 1 - (2 * i + 1.0) / kSteps;
      const double azimuth = std::numbers::pi * (j + 0.5) / kSteps;
      const double r = std::sqrt(1 - z * z);
      const Vec3 direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
      const double candela = table.intensity(direction);
      sum += candela * direction;
      total += candela;
    }
  return sum.norm() > kAllSidesAlike * total ? Vec3(sum.normalized()) : Vec3(0, 0, -1);
}

}  // namespace

PhotometricEmitter::PhotometricEmitter(const Light& light, const RayTracer& rays) {
  const double metres = rays.metres_per_unit();
  const double extent = opening_extent(light.opening) / metres;
  const double extent2 = extent * extent;
  std::optional<FlatOpening> flat = flat_opening(light.opening);
  if (flat) flat = {light.orientation * flat->along0 / metres, light.orientation * flat->along1 / metres};
  data_ = std::make_shared<const Data>(Data{light.table, light.opening,
                                            rays.normalised_double(light.position), light.orientation, metres,
                                            kNearest * kNearest * extent2, extent2, flat});
}

Vec3 PhotometricEmitter::point(double u0, double u1) const {
  if (data_->flat) return data_->centre + data_->flat->point(u0, u1);
  return data_->centre + data_->to_room * sample_opening(data_->opening, u0, u1) / data_->metres;
}

double PhotometricEmitter::geometry(const Vec3& to_light, const Vec3& n) const {
  const double height = n.dot(to_light);
  const double distance2 = to_light.squaredNorm();
  if (!(height > 0) || !(distance2 > 0)) return 0;
  return height /
         (std::sqrt(distance2) * std::max(distance2, data_->nearest2) * data_->metres * data_->metres);
}

float PhotometricEmitter::expected_irradiance(const Vec3f& x, const Vec3f& n) const {
  const Vec3 from = x.cast<double>();
  const Vec3 normal = n.cast<double>();
  const Vec3 to_centre = data_->centre - from;
  const auto rough = [&](const Vec3& to_light) {
    const double g = geometry(to_light, normal);
    return g > 0 ? g * data_->table->rough_intensity(in_luminaire(-to_light)) : 0.0;
  };
  const double height =
      normal.dot(to_centre) + opening_reach(data_->opening, in_luminaire(normal)) / data_->metres;
  if (!(height > 0)) return 0;
  const double distance2 = to_centre.squaredNorm();
  // A weight may be off by tens of per cent, which the few samples that it misplaces hardly show.
  constexpr double kFar2 = 1;
  double mean = 0;
  if (distance2 > kFar2 * data_->extent2 && normal.dot(to_centre) > 0) {
    mean = rough(to_centre);
  } else {
    constexpr std::array<std::array<double, 2>, 4> kPoints{{{0.2, 0.3}, {0.7, 0.2}, {0.3, 0.8}, {0.8, 0.7}}};
    for (const auto& [u0, u1] : kPoints) mean += 0.25 * rough(point(u0, u1) - from);
  }
  // What these points miss must keep a weight.
  constexpr double kLeast = 1e-3;
  const double around = data_->table->total_flux() / (4 * std::numbers::pi * data_->metres * data_->metres);
  const double least =
      kLeast * around * height / ((distance2 + data_->extent2) * std::sqrt(distance2 + data_->extent2));
  return static_cast<float>(std::max(mean, least));
}

LuminaireSample PhotometricEmitter::sample(const Vec3f& x, const Vec3f& n, float u0, float u1) const {
  const Vec3 from = x.cast<double>();
  const Vec3 p = point(static_cast<double>(u0), static_cast<double>(u1));
  const Vec3 to_light = p - from;
  LuminaireSample result;
  const double g = geometry(to_light, n.cast<double>());
  if (!(g > 0)) return result;
  result.factor = static_cast<float>(g * data_->table->intensity(in_luminaire(-to_light)));
  if (!(result.factor > 0)) return result;
  const double distance = to_light.norm();
  result.target = (p - std::min(0.5, kClear / distance) * to_light).cast<float>();
  return result;
}

LuminaireBounds PhotometricEmitter::bounds(float strength) const {
  const double reach = 0.5 * data_->opening.size().norm() / data_->metres;
  return sphere_bounds(data_->centre.cast<float>(), static_cast<float>(reach),
                       strength * static_cast<float>(data_->table->greatest_intensity()));
}

Vec3f PhotometricEmitter::mouth() const {
  const Vec3 aim = main_direction(*data_->table);
  const double reach = opening_reach(data_->opening, aim) / data_->metres + kClear;
  return (data_->centre + data_->to_room * (reach * aim)).cast<float>();
}

LightRay PhotometricEmitter::ray(const Vec3& from, const Vec3& direction_in_luminaire) const {
  const Vec3 away = data_->to_room * direction_in_luminaire;
  return {(from + kClear * away).cast<float>(), away.cast<float>().normalized()};
}

LightRay PhotometricEmitter::start_ray(float u0, float u1, float u2, float u3) const {
  return ray(point(static_cast<double>(u0), static_cast<double>(u1)),
             sample_intensity(*data_->table, static_cast<double>(u2), static_cast<double>(u3)));
}

void PhotometricEmitter::start_rays(const LightNumbers& u, std::span<LightRay> rays) const {
  SquarePoints16 at{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    at.u0[i] = static_cast<double>(u[2][i]);
    at.u1[i] = static_cast<double>(u[3][i]);
  }
  Directions16 to;
  sample_intensity16(*data_->table, at, to);
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = ray(point(static_cast<double>(u[0][i]), static_cast<double>(u[1][i])),
                  to.direction(static_cast<int>(i)));
}

}  // namespace reemit
