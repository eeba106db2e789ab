#include "solver/gather/seen_light.h"

#include <algorithm>
#include <bit>
#include <numbers>
#include <numeric>

#include "solver/gather/replicate_gather.h"
#include "solver/reflect/lambert.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Radiance over the scale below which what a ray ends on counts as dark: sealed voids, where no one is.
constexpr double kDarkEnd = 0.01;
/// Likewise a zone that is not looked at.
constexpr double kDarkZone = 0.05;
/// Share of a first ray of each point that get far, above which nothing is taken to hide a part of the zone.
constexpr double kOpen = 0.9;

}  // namespace

SeenLight::SeenLight(const RadianceField& field, const DirectLight& direct, std::span<const float> reflected,
                     std::span<const double> scale, std::uint64_t seed)
    : field_(&field), direct_(&direct), reflected_(reflected), scale_(scale), seed_(seed) {}

PointSampler SeenLight::sampler(ZoneId zone, SamplerNumber number) const {
  return {seed_, RngPurpose::kSeenLight, zone.index(), number, std::countr_zero(unsigned{kPoints})};
}

bool SeenLight::is_dark_end(ZoneId zone) const {
  const float* radiance = &reflected_[zone.index() * scale_.size()];
  for (std::size_t b = 0; b < scale_.size(); ++b)
    if (static_cast<double>(radiance[b]) > kDarkEnd * scale_[b]) return false;
  return true;
}

bool SeenLight::is_dark_zone(ZoneId zone, const Look& glance) const {
  const float* reflectance = field_->room().zone_reflectance(zone);
  for (std::size_t b = 0; b < scale_.size(); ++b) {
    double irradiance = 0;
    for (std::size_t i = 0; i < kPoints; ++i)
      irradiance += static_cast<double>(glance.irradiance[i * scale_.size() + b]) / kPoints;
    if (lambert_brdf_per_sr(reflectance[b]) * irradiance > kDarkZone * scale_[b]) return false;
  }
  return true;
}

SeenLight::Start SeenLight::start_in(ZoneId zone, const std::array<float, 2>& u) const {
  const SurfacePoint x = point_in_zone(field_->room(), zone, u);
  return {x, ray_origin(field_->room().rays(), x), Frame(x.normal)};
}

SeenLight::Points SeenLight::points_of(ZoneId zone, const PointSampler& place) const {
  Points points;
  for (int i = 0; i < kPoints; ++i) points[static_cast<std::size_t>(i)] = start_in(zone, place.place(i));
  return points;
}

SeenLight::Ends SeenLight::trace(const Ray16& rays, std::size_t count) const {
  const Room& room = field_->room();
  Ends ends;
  // Without second looks: a ray in a thousand that slips through a hairline changes no choice.
  room.rays().closest16(rays, static_cast<int>(count), ends.hits);
  room.mesh().zones_at16(ends.hits.points(), ends.zone);
  return ends;
}

void SeenLight::look_out(ZoneId zone, const Points& points, const PointSampler& sampler, int ray, int rays,
                         Look& look) const {
  Ray16 packet;
  for (int i = 0; i < kPoints; ++i)
    points[static_cast<std::size_t>(i)].set_ray(sampler.hemisphere(i, ray, rays), i, packet);
  const Ends ends = trace(packet, kPoints);
  const float reach = field_->zone_size(zone);
  const std::size_t bands = scale_.size();
  const float share = 1.0F / static_cast<float>(rays);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const bool is_far = ends.gets_far(i, reach);
    if (is_far) look.far += share / kPoints;
    if (!ends.is_on_zone(i)) continue;
    const float* radiance = &reflected_[ends.zone[i] * bands];
    for (std::size_t b = 0; b < bands; ++b)
      look.irradiance[i * bands + b] += std::numbers::pi_v<float> * share * radiance[b];
    if (is_far && !is_dark_end(ZoneId(ends.zone[i]))) look.open[i] += share;
  }
}

void SeenLight::add_direct(const Points& points, const PointSampler& sampler, int rays, Look& look) const {
  const std::size_t bands = scale_.size();
  const std::vector<float> weight(bands, 1.0F / static_cast<float>(rays));
  for (int i = 0; i < kPoints; ++i) {
    const auto shadow = [&](int ray) { return sampler.light(i, ray, rays); };
    const auto point = static_cast<std::size_t>(i);
    direct_->add_samples(points[point].point, rays, shadow, weight.data(), &look.irradiance[point * bands]);
  }
}

SeenLight::Look SeenLight::look_around(ZoneId zone, const Points& points, const PointSampler& sampler) const {
  Look found;
  found.irradiance.assign(kPoints * scale_.size(), 0.0F);
  add_direct(points, sampler, kShadowRays, found);
  for (int ray = 0; ray < kRays; ++ray) look_out(zone, points, sampler, ray, kRays, found);
  return found;
}

/// Openness of one look and light of the other, so that no noise is in both. Points that are spread evenly
/// have the zone's own mean, which takes no degree of freedom.
SeenLight::Half SeenLight::half_of(const std::array<float, kPoints>& open,
                                   const std::vector<float>& irradiance, std::size_t band) {
  const std::size_t bands = irradiance.size() / kPoints;
  double sum_open = 0;
  double sum_light = 0;
  double product = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto o = static_cast<double>(open[i]);
    const auto e = static_cast<double>(irradiance[i * bands + band]);
    sum_open += o;
    sum_light += e;
    product += o * e;
  }
  return {sum_open / kPoints, (product - sum_open * sum_light / kPoints) / kPoints};
}

SeenLight::Zone SeenLight::look(ZoneId zone) const {
  const Points points = points_of(zone, sampler(zone, kPlaces));
  Look glance;
  glance.irradiance.assign(kPoints * scale_.size(), 0.0F);
  look_out(zone, points, sampler(zone, kGlance), 0, 1, glance);
  const double openness = std::accumulate(glance.open.begin(), glance.open.end(), 0.0) / kPoints;
  // Where they end on, however dark: where packets are few, many zones are dark that need not be.
  if (glance.far > kOpen) return {openness, 0};
  // What other surfaces send mostly says that a zone is not dark, without a shadow ray.
  if (is_dark_zone(zone, glance)) {
    add_direct(points, sampler(zone, kGlance), 1, glance);
    if (is_dark_zone(zone, glance)) return {};
  }
  const Look one = look_around(zone, points, sampler(zone, kOneLook));
  const Look other = look_around(zone, points, sampler(zone, kOtherLook));
  const float* reflectance = field_->room().zone_reflectance(zone);
  Zone seen;
  double lit_bands = 0;
  for (std::size_t b = 0; b < scale_.size(); ++b) {
    if (!(scale_[b] > 0)) continue;
    ++lit_bands;
    const Half half = half_of(one.open, other.irradiance, b);
    const Half other_half = half_of(other.open, one.irradiance, b);
    seen.open = 0.5 * (half.open + other_half.open);
    if (seen.open == 0) return {};
    seen.misread += 0.5 * (half.covariance + other_half.covariance) / seen.open *
                    lambert_brdf_per_sr(reflectance[b]) / scale_[b];
  }
  if (lit_bands > 0) seen.misread /= lit_bands;
  return seen;
}

void SeenLight::look(ZoneId first, std::span<Zone> seen) const {
  constexpr int kEach = kPoints / kTogether;
  Ray16 rays;
  for (std::size_t z = 0; z < seen.size(); ++z) {
    const ZoneId zone(first.index() + z);
    const PointSampler numbers = sampler(zone, kGlance);
    for (int i = 0; i < kEach; ++i)
      start_in(zone, numbers.place(i))
          .set_ray(numbers.hemisphere(i, 0, 1), kEach * static_cast<int>(z) + i, rays);
  }
  const std::size_t count = seen.size() * kEach;
  const Ends ends = trace(rays, count);
  bool all_get_far = true;
  for (std::size_t i = 0; i < count && all_get_far; ++i)
    all_get_far = ends.gets_far(i, field_->zone_size(ZoneId(first.index() + i / kEach)));
  if (!all_get_far) {
    for (std::size_t z = 0; z < seen.size(); ++z) seen[z] = look(ZoneId(first.index() + z));
    return;
  }
  std::fill(seen.begin(), seen.end(), Zone{});
  for (std::size_t i = 0; i < count; ++i)
    if (ends.is_on_zone(i) && !is_dark_end(ZoneId(ends.zone[i]))) seen[i / kEach].open += 1.0 / kEach;
}

}  // namespace reemit
