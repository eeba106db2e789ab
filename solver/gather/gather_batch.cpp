#include "solver/gather/gather_batch.h"

#include <algorithm>
#include <utility>

namespace reemit {

GatherBatch::GatherBatch(const HemisphereGather& gather, int rays_of_place)
    : gather_(&gather),
      bands_(gather.band_count()),
      aims_(rays_of_place > 0 && !gather.bright().empty()),
      rays_of_place_(static_cast<float>(rays_of_place)),
      weights_(static_cast<std::size_t>(kWidth) * bands_) {}

void GatherBatch::add(const SurfacePoint& x, float u0, float u1, const PathKey& key, const float* weight,
                      float* sum, float* caustic) {
  if (!leave_from(x)) return;
  Way way{.key = key, .sum = sum, .caustic = caustic == nullptr ? sum : caustic};
  gather_->add_photons(x, u0, u1, key, weight, way.caustic);
  queue(frame_.to_world(sample_cosine_hemisphere(u0, u1)), way, weight);
}

void GatherBatch::add(const MeasuringPoint& x, float u0, float u1, const PathKey& key, const float* weight,
                      float* sum, float* caustic) {
  leave_from(x);
  const Way way{.key = key, .sum = sum, .caustic = caustic == nullptr ? sum : caustic};
  queue(frame_.to_world(sample_cosine_hemisphere(u0, u1)), way, weight);
}

template <class Place>
void GatherBatch::aim(const Place& x, const std::array<float, 3>& u, PathKey key, const float* weight,
                      float* sum, float* caustic) {
  if (!leave_from(x) || !(view_.total > 0)) return;
  const BrightZones::Aim aim = gather_->bright().aim(origin_, view_, u);
  if (!(aim.distance > 0)) return;
  key.index += PathKey::kOfAimed;
  const Way way{.key = key, .sum = sum, .caustic = caustic == nullptr ? sum : caustic, .aim = aim};
  queue(aim.direction, way, weight);
}
template void GatherBatch::aim(const SurfacePoint&, const std::array<float, 3>&, PathKey, const float*,
                               float*, float*);
template void GatherBatch::aim(const MeasuringPoint&, const std::array<float, 3>&, PathKey, const float*,
                               float*, float*);

void GatherBatch::queue(const Vec3f& direction, const Way& way, const float* weight) {
  // Below a shading normal's horizon there is only the surface itself.
  if (!(direction.dot(above_) > 0)) return;
  rays_.set(count_, origin_, direction);
  const auto lane = static_cast<std::size_t>(count_);
  ways_[lane] = way;
  ways_[lane].normal = normal_;
  ways_[lane].view = view_.total;
  ways_[lane].without_photons = without_photons_;
  std::copy_n(weight, bands_, &weights_[lane * bands_]);
  ++count_;
  while (count_ == kWidth) trace();
}

bool GatherBatch::leave_from(const SurfacePoint& x) {
  // Inside a body of glass most rays would go round for ever, and no one asks for light there.
  if (!x.front && gather_->room().surfaces().specular(x.triangle).is_body()) return false;
  if (x.triangle == from_.triangle && x.u == from_.u && x.v == from_.v && x.front == from_.front &&
      x.normal == from_.normal)
    return true;
  const RayTracer& rays = gather_->room().rays();
  from_ = x;
  origin_ = ray_origin(rays, x);
  above_ = side_normal(rays, x);
  normal_ = x.normal;
  frame_ = Frame(x.normal);
  without_photons_ = false;
  look_at_bright();
  return true;
}

bool GatherBatch::leave_from(const MeasuringPoint& x) {
  from_ = {};  // on no surface, so that no point is taken for it
  origin_ = x.place;
  above_ = normal_ = x.normal;
  frame_ = Frame(x.normal);
  without_photons_ = x.number == MeasuringPoint::kNoNumber;
  look_at_bright();
  return true;
}

void GatherBatch::look_at_bright() {
  if (aims_) gather_->bright().view(origin_, normal_, view_);
}

float GatherBatch::share_of_kind(int lane, const Way& way, ZoneId zone, const Hit16& hits) const {
  const bool is_aimed = way.aim.distance > 0;
  if (is_aimed && !way.aim.is_met(TriangleId(hits.triangle[lane]), hits.front[lane], hits.distance[lane]))
    return 0;
  if (!gather_->bright().holds(zone)) return is_aimed ? 0.0F : 1.0F;
  const Hit hit{TriangleId(hits.triangle[lane]), hits.u[lane], hits.v[lane], hits.distance[lane],
                hits.front[lane]};
  return gather_->share_of_kind({rays_.origin(lane), way.normal, way.view, rays_of_place_},
                                rays_.direction(lane), zone, hit);
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
  ways_[to] = ways_[lane];
  ways_[to].second_look = true;
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
    if (zones[i] != ZoneMesh::kNone) gather_->fetch(ZoneId(zones[i]), ways_[i].key.part);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t t = hits.triangle[i];
    if (!ways_[i].second_look && rays.is_doubtful(t, hits.u[i], hits.v[i], hits.front[i])) {
      keep_for_second_look(i, hits);
      continue;
    }
    if (zones[i] == ZoneMesh::kNone) continue;
    const Way& way = ways_[i];
    const ZoneId zone(zones[i]);
    float* weight = &weights_[i * bands_];
    if (aims_) {
      const float share = share_of_kind(static_cast<int>(i), way, zone, hits);
      if (share == 0) continue;
      for (std::size_t b = 0; b < bands_; ++b) weight[b] *= share;
    }
    if (gather_->continues(zone, hits.distance[i]) || surfaces.is_specular(TriangleId(t), hits.front[i])) {
      const Hit hit{TriangleId(t), hits.u[i], hits.v[i], hits.distance[i], hits.front[i]};
      gather_->add_continued(hit, rays_.direction(static_cast<int>(i)), way.key, way.without_photons, weight,
                             way.sum, way.caustic, true);
      continue;
    }
    const float* radiance = field.reflected(zone, way.key.part);
    for (std::size_t b = 0; b < bands_; ++b) way.sum[b] += weight[b] * radiance[b];
  }
}

}  // namespace reemit
