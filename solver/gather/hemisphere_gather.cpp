#include "solver/gather/hemisphere_gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/gather/aim_gain.h"
#include "solver/gather/uneven_zones.h"

namespace reemit {
namespace {

/// Bounces that no chance ends.
constexpr int kSureBounces = 4;
/// What aiming at bright zones has to be worth, as foreseen: at 1.8 stills took from a quarter less to a
/// quarter more time (docs/gather.md).
constexpr double kLeastGain = 2.2;
/// PointsInAir::rounds where light of small lamps comes over mirrors and glass.
constexpr int kRoundsInAir = 4;
/// Of rays that graze a bright zone.
constexpr float kLeastFacing = 1e-6F;

/// By zone, the distance within which a hit is continued [normalised units].
std::vector<float> reach_of_zones(const RadianceField& field, const DirectLight& direct,
                                  const GatherSettings& settings, const StopToken* stop) {
  const ZoneMesh& mesh = field.room().mesh();
  std::vector<float> reach(mesh.zone_count(), 0.0F);
  if (settings.close_hit == 0) return reach;
  std::vector<std::uint8_t> uneven(mesh.zone_count(), 0);
  if (settings.continue_uneven)
    uneven = settings.plan != nullptr && settings.plan->uneven.size() == uneven.size()
                 ? settings.plan->uneven
                 : uneven_zones(field, direct, settings.seed, stop);
  for (std::size_t z = 0; z < reach.size(); ++z) {
    const bool is_little_known = settings.little_known != nullptr && (*settings.little_known)[z] != 0;
    reach[z] = uneven[z] != 0 || is_little_known
                   ? std::numeric_limits<float>::infinity()
                   : static_cast<float>(settings.close_hit) * field.zone_size(ZoneId(z));
  }
  return reach;
}

CausticMap caustic_map(const RadianceField& field, const GatherSettings& settings, const StopToken* stop) {
  if (!settings.caustics) return {};
  const GatherPlan* plan = settings.plan;
  const bool is_known = plan != nullptr && plan->caustics;
  const PointsInAir in_air{settings.in_air, field.has_light_that_rays_miss() ? kRoundsInAir : 1};
  return {field.room(),
          field.parts(),
          is_known ? plan->seed : settings.seed,
          is_known ? &*plan->caustics : nullptr,
          stop,
          in_air};
}

}  // namespace

HemisphereGather::HemisphereGather(const RadianceField& field, const DirectLight& direct,
                                   const GatherSettings& settings, const StopToken* stop)
    : field_(&field),
      direct_(&direct),
      caustics_(caustic_map(field, settings, stop)),
      bright_(settings.aim_at_bright ? BrightZones(field) : BrightZones()),
      white_(field.band_count(), 1.0F),
      reach_(reach_of_zones(field, direct, settings, stop)),
      most_bounces_(settings.most_bounces),
      rng_(settings.seed, RngPurpose::kHemisphere),
      specular_(settings.seed, RngPurpose::kSpecular, RngPurpose::kSpread) {
  if (!bright_.empty() && aim_gain(*this, direct, settings.seed) < kLeastGain) bright_ = {};
}

void HemisphereGather::add_continued(const Hit& y, const Vec3f& direction, const PathKey& key,
                                     bool without_photons, float* weight, float* sum, float* caustic,
                                     bool aims) const {
  const RayTracer& rays = room().rays();
  const SurfaceModel& surfaces = room().surfaces();
  const std::size_t bands = band_count();
  Hit hit = y;
  Vec3f along = direction;
  float way = 0;  // from the last surface that scattered the light
  SpecularPath path(room(), specular_, key, {&caustics_, false, without_photons});
  for (int bounce = 0;;) {
    const ZoneId zone = room().mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
    if (!zone.valid()) return;
    way += hit.distance;
    float* over_mirrors = path.is_scattered() ? sum : caustic;
    path.arrive(*direct_, hit, along, weight, over_mirrors);
    const float* here = path.of_light_there(weight);
    const bool is_read = bounce == most_bounces_ || !continues(zone, way);
    if (is_read) {
      const float* radiance = field_->reflected(zone, key.part);
      for (std::size_t b = 0; b < bands; ++b) sum[b] += here[b] * radiance[b];
    }
    const bool specular = surfaces.is_specular(hit.triangle, hit.front);
    if (is_read && !specular) return;
    const SurfacePoint point = surface_point(rays, hit, along);
    float scattered = 1;  // chance that the ray goes on from here as scattered light
    SurfaceModel::PointValues at_point;
    if (specular) {
      const float* reflectance = surfaces.reflectance(point, at_point);
      const DiffuseWay diffuse = is_read ? DiffuseWay::kNotFollowed : DiffuseWay::kFollowed;
      scattered = is_read ? 0 : *std::max_element(reflectance, reflectance + bands);
      if (scattered > 0) add_direct(point, bounce, key, here, sum);
      if (surfaces.spreads(hit.triangle)) {
        const std::array<float, 4> u = numbers(bounce, key);
        direct_->add_lobe_sample(point, {u[0], u[1], u[2]}, path.counted(), diffuse, here,
                                 {over_mirrors, sum});
      }
      if (diffuse == DiffuseWay::kFollowed) add_photons_beyond(point, bounce, key, here, sum);
      const SpecularPath::Next next = path.choose(point, diffuse, scattered, weight);
      if (next == SpecularPath::Next::kEnds) return;
      if (next == SpecularPath::Next::kGoesOn) {
        along = path.direction();
        if (!rays.closest(path.origin(), along, hit)) {
          path.leave(along, weight, path.is_scattered() ? sum : caustic);
          return;
        }
        continue;
      }
    }
    const auto number = static_cast<std::uint32_t>(2 * bounce + 1);
    const std::array<float, 4> u_ray = rng_.uniform4(key.index, key.batch, key.step(number));
    const ScatterSample next = surfaces.sample(point, u_ray[0], u_ray[1]);
    const BrdfValue brdf = surfaces.value(point, next.direction, at_point);
    bool dark = true;
    for (std::size_t b = 0; b < bands; ++b) dark = dark && weight[b] * brdf(b) == 0;
    if (dark) return;
    if (!specular) add_direct(point, bounce, key, here, sum);
    const bool is_close = reach_[zone.index()] < std::numeric_limits<float>::infinity();
    const float view =
        aims && is_close && here == weight ? add_aimed(point, bounce, key, brdf, scattered, weight, sum) : 0;
    float most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, brdf(b) * next.cosine_over_pdf);
    const float survives = bounce < kSureBounces ? 1.0F : std::min(1.0F, most);
    if (!(u_ray[2] < survives)) return;
    for (std::size_t b = 0; b < bands; ++b) {
      weight[b] *= brdf(b) / (scattered * survives);
      weight[b] *= next.cosine_over_pdf;
    }
    along = next.direction;
    const Vec3f origin = ray_origin(rays, point);
    if (!rays.closest(origin, along, hit)) return;
    if (view > 0) {
      const ZoneId met = room().mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
      const float share = met.valid() && bright_.holds(met)
                              ? share_of_kind({origin, point.normal, view, 1}, along, met, hit)
                              : 1;
      for (std::size_t b = 0; b < bands; ++b) weight[b] *= share;
    }
    way = 0;
    path.scatter();
    ++bounce;
  }
}

float HemisphereGather::share_of_kind(const AimingPoint& x, const Vec3f& along, ZoneId met,
                                      const Hit& hit) const {
  const float cosine = along.dot(x.normal);
  if (!(cosine > 0)) return 0;
  const float facing = -along.dot(side_normal(room().rays(), hit.triangle, hit.u, hit.v, hit.front));
  const float aimed =
      bright_.pdf_per_sr(x.origin, x.normal, x.view, met, std::max(facing, kLeastFacing), hit.distance);
  const float others = x.others * cosine * std::numbers::inv_pi_v<float>;
  return others / (others + aimed);
}

float HemisphereGather::add_aimed(const SurfacePoint& y, int bounce, const PathKey& key,
                                  const BrdfValue& brdf, float chance, const float* weight,
                                  float* sum) const {
  if (bright_.empty()) return 0;
  const RayTracer& rays = room().rays();
  const Vec3f origin = ray_origin(rays, y);
  BrightZones::View view;
  bright_.view(origin, y.normal, view);
  if (!(view.total > 0)) return 0;
  const auto number = static_cast<std::uint32_t>(2 * bounce + 1);
  const std::array<float, 4> u = rng_.uniform4(key.index + PathKey::kOfAiming, key.batch, key.step(number));
  const BrightZones::Aim aim = bright_.aim(origin, view, {u[0], u[1], u[2]});
  const Vec3f& along = aim.direction;
  Hit hit;
  if (!(aim.distance > 0) || !(along.dot(y.normal) > 0) || !rays.closest(origin, along, hit) ||
      !aim.is_met(hit.triangle, hit.front, hit.distance))
    return view.total;
  const ZoneId met = room().mesh().zone_at(hit.triangle, hit.u, hit.v, hit.front);
  if (!met.valid() || !bright_.holds(met)) return view.total;
  // Over pi: what rays of a Lambertian lobe count for.
  const float share =
      share_of_kind({origin, y.normal, view.total, 1}, along, met, hit) * std::numbers::pi_v<float> / chance;
  std::vector<float> of_ray(band_count());
  for (std::size_t b = 0; b < of_ray.size(); ++b) of_ray[b] = weight[b] * brdf(b) * share;
  if (continues(met, hit.distance) || room().surfaces().is_specular(hit.triangle, hit.front)) {
    PathKey on = key;
    on.index += PathKey::kOfAimedBounce * static_cast<std::uint64_t>(bounce + 1);
    add_continued(hit, along, on, false, of_ray.data(), sum, sum, false);
    return view.total;
  }
  const float* radiance = field_->reflected(met, key.part);
  for (std::size_t b = 0; b < of_ray.size(); ++b) sum[b] += of_ray[b] * radiance[b];
  return view.total;
}

void HemisphereGather::add_direct(const SurfacePoint& y, int bounce, const PathKey& key, const float* weight,
                                  float* sum) const {
  const std::array<float, 4> u = numbers(bounce, key);
  direct_->add_reflected_sample(y, {u[0], u[1], u[2]}, 1, weight, sum);
  if (!caustics_.exists() || !(u[3] < kPhotonLooks)) return;
  SurfaceModel::PointValues at_point;
  const float* reflectance = room().surfaces().reflectance(y, at_point);
  caustics_.add_reflected(y, key.part, true, u[3] / kPhotonLooks,
                          {reflectance, std::numbers::inv_pi_v<float> / kPhotonLooks}, weight, sum);
}

void HemisphereGather::add_photons_beyond(const SurfacePoint& y, int bounce, const PathKey& key,
                                          const float* weight, float* sum) const {
  const SpecularSurface& surface = room().surfaces().specular(y.triangle);
  if (!surface.diffuses() || !caustics_.exists()) return;
  const float u = numbers(bounce, key)[3];
  if (!(u < kPhotonLooks)) return;
  caustics_.add_reflected(
      other_side(room().rays(), y), key.part, true, u / kPhotonLooks,
      {surface.diffuse_transmittance().data(), std::numbers::inv_pi_v<float> / kPhotonLooks}, weight, sum);
}

std::array<float, 4> HemisphereGather::numbers(int bounce, const PathKey& key) const {
  return rng_.uniform4(key.index, key.batch, key.step(static_cast<std::uint32_t>(2 * bounce)));
}

}  // namespace reemit
