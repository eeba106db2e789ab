#include "solver/gather/hemisphere_gather.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/gather/uneven_zones.h"

namespace reemit {
namespace {

/// Bounces that no chance ends.
constexpr int kSureBounces = 4;

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
  return {field.room(), field.parts(), is_known ? plan->seed : settings.seed,
          is_known ? &*plan->caustics : nullptr, stop};
}

}  // namespace

HemisphereGather::HemisphereGather(const RadianceField& field, const DirectLight& direct,
                                   const GatherSettings& settings, const StopToken* stop)
    : field_(&field),
      direct_(&direct),
      caustics_(caustic_map(field, settings, stop)),
      white_(field.band_count(), 1.0F),
      reach_(reach_of_zones(field, direct, settings, stop)),
      most_bounces_(settings.most_bounces),
      rng_(settings.seed, RngPurpose::kHemisphere),
      specular_(settings.seed, RngPurpose::kSpecular, RngPurpose::kSpread) {}

void HemisphereGather::add_continued(const Hit& y, const Vec3f& direction, const PathKey& key, bool from_air,
                                     float* weight, float* sum, float* caustic) const {
  const RayTracer& rays = room().rays();
  const SurfaceModel& surfaces = room().surfaces();
  const std::size_t bands = band_count();
  Hit hit = y;
  Vec3f along = direction;
  float way = 0;  // from the last surface that scattered the light
  SpecularPath path(room(), specular_, key, {&caustics_, false, from_air});
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
    float most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, brdf(b) * next.cosine_over_pdf);
    const float survives = bounce < kSureBounces ? 1.0F : std::min(1.0F, most);
    if (!(u_ray[2] < survives)) return;
    for (std::size_t b = 0; b < bands; ++b) {
      weight[b] *= brdf(b) / (scattered * survives);
      weight[b] *= next.cosine_over_pdf;
    }
    along = next.direction;
    if (!rays.closest(ray_origin(rays, point), along, hit)) return;
    way = 0;
    path.scatter();
    ++bounce;
  }
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

GatherBatch::GatherBatch(const HemisphereGather& gather)
    : gather_(&gather), bands_(gather.band_count()), weights_(static_cast<std::size_t>(kWidth) * bands_) {}

void GatherBatch::add(const SurfacePoint& x, float u0, float u1, const PathKey& key, const float* weight,
                      float* sum, float* caustic) {
  if (caustic == nullptr) caustic = sum;
  // Inside a body of glass most rays would go round for ever, and no one asks for light there.
  if (!x.front && gather_->room().surfaces().specular(x.triangle).is_body()) return;
  gather_->add_photons(x, u0, u1, key, weight, caustic);
  leave_from(x);
  queue(u0, u1, key, false, weight, sum, caustic);
}

void GatherBatch::add(const MeasuringPoint& x, float u0, float u1, const PathKey& key, const float* weight,
                      float* sum, float* caustic) {
  from_ = {};  // on no surface, so that no point is taken for it
  origin_ = x.place;
  above_ = x.normal;
  frame_ = Frame(x.normal);
  queue(u0, u1, key, true, weight, sum, caustic == nullptr ? sum : caustic);
}

void GatherBatch::queue(float u0, float u1, const PathKey& key, bool from_air, const float* weight,
                        float* sum, float* caustic) {
  const Vec3f direction = frame_.to_world(sample_cosine_hemisphere(u0, u1));
  // Below a shading normal's horizon there is only the surface itself.
  if (!(direction.dot(above_) > 0)) return;
  rays_.set(count_, origin_, direction);
  const auto lane = static_cast<std::size_t>(count_);
  second_look_[lane] = false;
  from_air_[lane] = from_air;
  keys_[lane] = key;
  sums_[lane] = sum;
  caustics_[lane] = caustic;
  std::copy_n(weight, bands_, &weights_[lane * bands_]);
  ++count_;
  while (count_ == kWidth) trace();
}

void GatherBatch::leave_from(const SurfacePoint& x) {
  if (x.triangle == from_.triangle && x.u == from_.u && x.v == from_.v && x.front == from_.front &&
      x.normal == from_.normal)
    return;
  const RayTracer& rays = gather_->room().rays();
  from_ = x;
  origin_ = ray_origin(rays, x);
  above_ = side_normal(rays, x);
  frame_ = Frame(x.normal);
}

void GatherBatch::flush() {
  while (count_ > 0) trace();
}

// Puts a ray back into the queue, turned a little, where it costs no block of its own.
void GatherBatch::keep_for_second_look(std::size_t lane, const Hit16& hits) {
  const int ray = static_cast<int>(lane);
  const RayTracer& rays = gather_->room().rays();
  rays_.set(count_, rays_.origin(ray), rays.second_direction(rays_.direction(ray), hits, ray),
            rays.cut_out_key(rays_, ray));
  const auto to = static_cast<std::size_t>(count_++);
  second_look_[to] = true;
  from_air_[to] = from_air_[lane];
  keys_[to] = keys_[lane];
  sums_[to] = sums_[lane];
  caustics_[to] = caustics_[lane];
  std::copy_n(&weights_[lane * bands_], bands_, &weights_[to * bands_]);
}

void GatherBatch::trace() {
  const RadianceField& field = gather_->field();
  const RayTracer& rays = gather_->room().rays();
  const ZoneMesh& mesh = gather_->room().mesh();
  const SurfaceModel& surfaces = gather_->room().surfaces();
  Hit16 hits;
  rays.closest16(rays_, count_, hits);
  const auto count = static_cast<std::size_t>(std::exchange(count_, 0));
  alignas(64) std::uint32_t zones[kWidth];
  mesh.zones_at16(hits.points(), zones);
  // What is read of a room of many zones is rarely in the cache: all of it is asked for before any is used.
  for (std::size_t i = 0; i < count; ++i)
    if (zones[i] != ZoneMesh::kNone) gather_->fetch(ZoneId(zones[i]), keys_[i].part);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t t = hits.triangle[i];
    if (!second_look_[i] && rays.is_doubtful(t, hits.u[i], hits.v[i], hits.front[i])) {
      keep_for_second_look(i, hits);
      continue;
    }
    if (zones[i] == ZoneMesh::kNone) continue;
    float* weight = &weights_[i * bands_];
    const ZoneId zone(zones[i]);
    if (gather_->continues(zone, hits.distance[i]) || surfaces.is_specular(TriangleId(t), hits.front[i])) {
      const Hit hit{TriangleId(t), hits.u[i], hits.v[i], hits.distance[i], hits.front[i]};
      gather_->add_continued(hit, rays_.direction(static_cast<int>(i)), keys_[i], from_air_[i], weight,
                             sums_[i], caustics_[i]);
      continue;
    }
    const float* radiance = field.reflected(zone, keys_[i].part);
    for (std::size_t b = 0; b < bands_; ++b) sums_[i][b] += weight[b] * radiance[b];
  }
}

}  // namespace reemit
