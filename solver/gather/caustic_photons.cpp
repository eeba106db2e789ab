#include "solver/gather/caustic_photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "solver/reflect/specular.h"
#include "solver/sampling/counter_rng.h"
#include "solver/shoot/flight.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 1U << 14;
/// Packets between mirrors end there: what is left of them lights nothing that could be seen.
constexpr std::uint32_t kMostSteps = 1024;
constexpr std::uint32_t kAll16 = 0xffff;

/// Of packets first .. first+15 of those that there are, by bit. Pre: first is a multiple of 16.
std::uint32_t marks_of16(const CausticShooter::Marks& marks, std::uint32_t first) {
  const std::size_t byte = first / 8;
  std::uint32_t bits = marks[byte];
  if (byte + 1 < marks.size()) bits |= static_cast<std::uint32_t>(marks[byte + 1]) << 8U;
  return bits;
}

}  // namespace

bool CausticPhotons::is_on_face(std::uint32_t i, const Vec3f& normal, const Vec3f& place,
                                float radius) const {
  constexpr float kFlat = 0.15F;
  return normals[i].dot(normal) > kSameFace && std::fabs((places[i] - place).dot(normal)) < kFlat * radius;
}

void CausticPhotons::append(const CausticPhotons& more) {
  places.insert(places.end(), more.places.begin(), more.places.end());
  normals.insert(normals.end(), more.normals.begin(), more.normals.end());
  triangles.insert(triangles.end(), more.triangles.begin(), more.triangles.end());
  luminaires.insert(luminaires.end(), more.luminaires.begin(), more.luminaires.end());
  power.insert(power.end(), more.power.begin(), more.power.end());
  radius_codes.insert(radius_codes.end(), more.radius_codes.begin(), more.radius_codes.end());
}

CausticPhotons mean_of(std::vector<CausticPhotons> estimates) {
  if (estimates.size() == 1) return std::move(estimates.front());
  CausticPhotons mean;
  for (const CausticPhotons& estimate : estimates) mean.append(estimate);
  for (float& watts : mean.power) watts /= static_cast<float>(estimates.size());
  return mean;
}

CausticShooter::CausticShooter(const Room& room, std::uint64_t seed)
    : transport_(room), emission_(collect_packet_sources(transport_)), seed_(seed) {}

std::vector<float> CausticShooter::density_of_surfaces(double packets) const {
  const double metres = transport_.rays().metres_per_unit();
  std::vector<double> share(transport_.surfaces(), 0.0), area(transport_.surfaces(), 0.0);
  double all = 0;
  for (std::size_t s = 0; s < emission_.sources.size(); ++s) {
    double quanta = 0;
    for (const std::int64_t q : emission_.quanta_of(s)) quanta += static_cast<double>(q);
    all += quanta;
    const ZoneId zone = emission_.sources[s].zone;
    if (!zone.valid()) continue;
    const std::size_t surface = transport_.mesh().zone_surface(zone).index();
    share[surface] += quanta;
    area[surface] += transport_.mesh().zone_area(zone) / (metres * metres);
  }
  std::vector<float> density(share.size(), 0.0F);
  for (std::size_t s = 0; s < share.size(); ++s)
    if (area[s] > 0) density[s] = static_cast<float>(packets * share[s] / (all * area[s]));
  return density;
}

CausticPhotons CausticShooter::shoot(std::uint32_t packets, std::uint32_t batch,
                                     const Options& options) const {
  CausticPhotons all;
  if (emission_.sources.empty()) return all;
  const Channels channels = transport_.channels();
  const double offset = static_cast<double>(CounterRng(seed_, RngPurpose::kCaustic).uniform4(0, batch, 0)[0]);
  const Flight flight = plan_first_flight(emission_, packets, offset);
  const std::size_t mark_bytes = (flight.packets() + std::size_t{7}) / 8;
  const Marks* marked = options.marked;
  if (marked != nullptr && marked->size() != mark_bytes) marked = nullptr;
  Marks* brought = options.brought;
  if (brought != nullptr) brought->assign(mark_bytes, 0);
  const FlightNumbers numbers(SamplingKind::kSobol, seed_ ^ 0x9e3779b97f4a7c15ULL, batch, 0);
  const std::uint32_t tasks = (flight.packets() + kPacketsPerTask - 1) / kPacketsPerTask;
  std::vector<CausticPhotons> of_task(tasks);
  tbb::parallel_for(std::uint32_t{0}, tasks, [&](std::uint32_t task) {
    const std::uint32_t begin = task * kPacketsPerTask;
    const std::uint32_t end = std::min(flight.packets(), begin + kPacketsPerTask);
    FlightCursor cursor(transport_, flight, begin);
    Ray16 rays;
    std::vector<std::int64_t> quanta(16 * channels.count());
    std::vector<float> power(channels.bands());
    for (std::uint32_t first = begin; first < end; first += 16) {
      if (options.stop != nullptr && options.stop->requested()) return;
      const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
      std::uint32_t followed = marked != nullptr ? marks_of16(*marked, first) : kAll16;
      if (followed == 0) continue;
      cursor.start16(first, count, numbers, rays, quanta.data());
      if (marked == nullptr) followed = meet_mirrors(rays, count);
      for (int lane = 0; lane < count; ++lane) {
        if ((followed >> lane & 1U) == 0) continue;
        const std::uint32_t id = first + static_cast<std::uint32_t>(lane);
        const auto source = static_cast<std::size_t>(
            std::upper_bound(flight.first_packet.begin(), flight.first_packet.end(), id) -
            flight.first_packet.begin() - 1);
        const ZoneId zone = flight.sources[source].zone;
        if (!zone.valid() && transport_.is_found_by_rays(flight.sources[source].light)) continue;
        const SurfaceId luminaire = zone.valid() ? transport_.mesh().zone_surface(zone) : SurfaceId();
        const std::int64_t* own = &quanta[static_cast<std::size_t>(lane) * channels.count()];
        std::fill(power.begin(), power.end(), 0.0F);
        channels.for_each([&](std::size_t c, std::size_t band) {
          power[band] += static_cast<float>(emission_.watts_per_quantum[c] * static_cast<double>(own[c]));
        });
        const std::size_t before = of_task[task].size();
        follow(rays.origin(lane), rays.direction(lane), id, batch, luminaire, power, of_task[task]);
        // A task has bytes of its own.
        if (brought != nullptr && of_task[task].size() > before)
          (*brought)[id / 8] = static_cast<std::uint8_t>((*brought)[id / 8] | 1U << (id % 8));
      }
    }
  });
  for (const CausticPhotons& photons : of_task) all.append(photons);
  return all;
}

std::uint32_t CausticShooter::meet_mirrors(const Ray16& rays, int count) const {
  Hit16 hits;
  transport_.rays().closest16(rays, count, hits);
  std::uint32_t met = 0;
  for (int lane = 0; lane < count; ++lane)
    if (hits.triangle[lane] != RayTracer::kMiss &&
        transport_.surface_model().is_specular(TriangleId(hits.triangle[lane]), hits.front[lane]))
      met |= 1U << lane;
  return met;
}

void CausticShooter::follow(const Vec3f& origin, const Vec3f& direction, std::uint32_t id,
                            std::uint32_t batch, SurfaceId luminaire, std::vector<float>& power,
                            CausticPhotons& result) const {
  const RayTracer& rays = transport_.rays();
  const SurfaceModel& surfaces = transport_.surface_model();
  const std::size_t bands = transport_.channels().bands();
  const CounterRng choice(seed_, RngPurpose::kCaustic);
  SpecularStep step(bands);
  Vec3f from = origin;
  Vec3f along = direction;
  TriangleId body;
  bool bent = false;
  for (std::uint32_t n = 0; n < kMostSteps; ++n) {
    Hit hit;
    if (!rays.closest(from, along, hit)) return;
    if (!transport_.mesh().has_zones(hit.triangle, hit.front)) return;
    surfaces.attenuate(surfaces.body_around(hit.triangle, hit.front, body), hit.distance, power.data());
    const SurfacePoint x = surface_point(rays, hit, along);
    const float* reflectance = surfaces.reflectance(hit.triangle, hit.front);
    if (bent && std::any_of(reflectance, reflectance + bands, [](float rho) { return rho > 0; })) {
      result.places.push_back(from + hit.distance * along);
      result.normals.push_back(x.normal);
      result.triangles.push_back(hit.triangle);
      result.luminaires.push_back(luminaire);
      result.power.insert(result.power.end(), power.begin(), power.end());
    }
    if (!surfaces.is_specular(hit.triangle, hit.front)) return;
    const std::array<float, 4> u = choice.uniform4(id, batch, n + 1);
    if (!surfaces.specular(hit.triangle).choose(x, u[0], {u[1], u[2]}, Survival::kRoulette, step)) return;
    if (step.is_wide) return;
    for (std::size_t b = 0; b < bands; ++b) power[b] *= step.share()[b] / step.chance;
    bent = bent || step.bends;
    body = surfaces.body_beyond(hit.triangle, step.front, body);
    from = rays.ray_origin(hit.triangle, hit.u, hit.v, step.front);
    along = step.direction;
  }
}

}  // namespace reemit
