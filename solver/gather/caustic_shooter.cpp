#include "solver/gather/caustic_shooter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "solver/reflect/specular.h"
#include "solver/sampling/counter_rng.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/ray_lanes.h"
#include "solver/trace/surface_point.h"

namespace reemit {
namespace {

constexpr std::uint32_t kCausticPacketsPerTask = 1U << 14;
/// Packets between mirrors end there: what is left of them lights nothing that could be seen.
constexpr std::uint32_t kMostSteps = 1024;
/// Inside of glass sooner: a ten thousandth of what comes in goes round in a ball so often, and of the light
/// of a luminaire that stands in one what is reflected totally for ever.
constexpr std::uint32_t kMostStepsInGlass = 128;
constexpr std::uint32_t kAll16 = 0xffff;

/// Of packets first .. first+15 of those that there are, by bit. Pre: first is a multiple of 16.
std::uint32_t marks_of16(const CausticShooter::Marks& marks, std::uint32_t first) {
  const std::size_t byte = first / 8;
  std::uint32_t bits = marks[byte];
  if (byte + 1 < marks.size()) bits |= static_cast<std::uint32_t>(marks[byte + 1]) << 8U;
  return bits;
}

/// Whether anybody may ask for the light that comes to a point: all but smooth mirrors and glass scatter
/// some, and what is black may be there to be measured on.
bool takes_light(const SurfaceModel& surfaces, const Hit& hit) {
  if (!surfaces.is_specular(hit.triangle, hit.front)) return true;
  const float* reflectance = surfaces.reflectance(hit.triangle, hit.front);
  return surfaces.specular(hit.triangle).diffuses() ||
         std::any_of(reflectance, reflectance + surfaces.band_count(), [](float rho) { return rho > 0; });
}

}  // namespace

CausticShooter::CausticShooter(const Room& room, std::uint64_t seed)
    : transport_(room),
      emission_(collect_packet_sources(transport_)),
      seed_(seed),
      mirrors_(room.rays(), mirrors_of(room)) {}

bool CausticShooter::is_mirror(const SurfaceModel& surfaces, TriangleId t, bool front) {
  return surfaces.is_specular(t, front) && surfaces.specular(t).sends_narrowly();
}

std::vector<bool> CausticShooter::mirrors_of(const Room& room) {
  std::vector<bool> mirrors(room.mesh().triangle_count());
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    const TriangleId t(i);
    mirrors[i] = is_mirror(room.surfaces(), t, true) || is_mirror(room.surfaces(), t, false);
  }
  return mirrors;
}

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

/// Packets of one task: those that may meet a mirror are put together to blocks of 16, so that few are traced
/// in vain, and followed in the order of their numbers.
class CausticShooter::Task {
 public:
  Task(const CausticShooter& shooter, const Flight& flight, std::uint32_t batch, const Options& options,
       const Marks* marked, PhotonCatch& result)
      : shooter_(shooter),
        flight_(flight),
        batch_(batch),
        options_(options),
        marked_(marked),
        channels_(shooter.transport_.channels()),
        result_(result),
        quanta_(16 * channels_.count()),
        waiting_quanta_(16 * channels_.count()),
        power_(channels_.bands()) {}

  void run(const FlightNumbers& numbers, std::uint32_t begin, std::uint32_t end) {
    FlightCursor cursor(shooter_.transport_, flight_, begin);
    for (std::uint32_t first = begin; first < end; first += 16) {
      if (options_.stop != nullptr && options_.stop->requested()) return;
      const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
      std::uint32_t chosen = marked_ != nullptr ? marks_of16(*marked_, first) : kAll16;
      chosen &= lane_bits(0, count);
      if (chosen == 0) continue;
      cursor.start16(first, count, numbers, rays_, quanta_.data());
      if (marked_ == nullptr) chosen &= shooter_.mirrors_.crossed16(rays_, count);
      for_lanes(chosen, [&](int lane) {
        put(first + static_cast<std::uint32_t>(lane), lane);
        if (waiting_ == 16) follow_waiting();
      });
    }
    follow_waiting();
  }

 private:
  void put(std::uint32_t id, int lane) {
    waiting_rays_.set(waiting_, rays_.origin(lane), rays_.direction(lane));
    id_[waiting_] = id;
    std::copy_n(&quanta_[static_cast<std::size_t>(lane) * channels_.count()], channels_.count(),
                &waiting_quanta_[static_cast<std::size_t>(waiting_) * channels_.count()]);
    ++waiting_;
  }

  void follow_waiting() {
    const int count = std::exchange(waiting_, 0);
    if (count == 0) return;
    const std::uint32_t followed =
        marked_ != nullptr ? lane_bits(0, count) : shooter_.go_on(waiting_rays_, count, id_, batch_);
    for_lanes(followed, [&](int lane) { follow(lane); });
  }

  void follow(int lane) {
    const std::uint32_t id = id_[lane];
    const auto source = static_cast<std::size_t>(
        std::upper_bound(flight_.first_packet.begin(), flight_.first_packet.end(), id) -
        flight_.first_packet.begin() - 1);
    const PacketRoom& transport = shooter_.transport_;
    const ZoneId zone = flight_.sources[source].zone;
    if (!zone.valid() && transport.is_found_by_rays(flight_.sources[source].light)) return;
    const SurfaceId luminaire = zone.valid() ? transport.mesh().zone_surface(zone) : SurfaceId();
    const std::int64_t* own = &waiting_quanta_[static_cast<std::size_t>(lane) * channels_.count()];
    std::fill(power_.begin(), power_.end(), 0.0F);
    channels_.for_each([&](std::size_t c, std::size_t band) {
      power_[band] +=
          static_cast<float>(shooter_.emission_.watts_per_quantum[c] * static_cast<double>(own[c]));
    });
    const std::size_t before = result_.on_surfaces.size();
    shooter_.follow({waiting_rays_.origin(lane), waiting_rays_.direction(lane), id, batch_, luminaire},
                    power_, options_, result_);
    // A task has bytes of its own.
    if (options_.brought != nullptr && result_.on_surfaces.size() > before)
      (*options_.brought)[id / 8] = static_cast<std::uint8_t>((*options_.brought)[id / 8] | 1U << (id % 8));
  }

  const CausticShooter& shooter_;
  const Flight& flight_;
  std::uint32_t batch_;
  const Options& options_;
  const Marks* marked_;
  Channels channels_;
  PhotonCatch& result_;
  Ray16 rays_{};
  std::vector<std::int64_t> quanta_;
  Ray16 waiting_rays_{};
  int waiting_ = 0;
  std::uint32_t id_[16] = {};
  std::vector<std::int64_t> waiting_quanta_;
  std::vector<float> power_;
};

PhotonCatch CausticShooter::shoot(std::uint32_t packets, std::uint32_t batch, const Options& options) const {
  PhotonCatch all;
  if (emission_.sources.empty()) return all;
  const double offset = static_cast<double>(CounterRng(seed_, RngPurpose::kCaustic).uniform4(0, batch, 0)[0]);
  const Flight flight = plan_first_flight(emission_, packets, offset);
  const std::size_t mark_bytes = (flight.packets() + std::size_t{7}) / 8;
  const Marks* marked = options.marked;
  if (marked != nullptr && marked->size() != mark_bytes) marked = nullptr;
  if (options.brought != nullptr) options.brought->assign(mark_bytes, 0);
  const FlightNumbers numbers(SamplingKind::kSobol, seed_ ^ 0x9e3779b97f4a7c15ULL, batch, 0);
  const std::uint32_t tasks = (flight.packets() + kCausticPacketsPerTask - 1) / kCausticPacketsPerTask;
  std::vector<PhotonCatch> of_task(tasks);
  tbb::parallel_for(std::uint32_t{0}, tasks, [&](std::uint32_t task) {
    const std::uint32_t begin = task * kCausticPacketsPerTask;
    const std::uint32_t end = std::min(flight.packets(), begin + kCausticPacketsPerTask);
    Task(*this, flight, batch, options, marked, of_task[task]).run(numbers, begin, end);
  });
  for (const PhotonCatch& photons : of_task) {
    all.on_surfaces.append(photons.on_surfaces);
    all.in_air.append(photons.in_air);
  }
  return all;
}

std::uint32_t CausticShooter::go_on(const Ray16& rays, int count, const std::uint32_t* id,
                                    std::uint32_t batch) const {
  const SurfaceModel& surfaces = transport_.surface_model();
  const CounterRng choice(seed_, RngPurpose::kCaustic);
  Hit16 hits;
  transport_.rays().closest16(rays, count, hits);
  std::uint32_t on = 0;
  for (int lane = 0; lane < count; ++lane) {
    const TriangleId t(hits.triangle[lane]);
    if (hits.triangle[lane] == RayTracer::kMiss || !is_mirror(surfaces, t, hits.front[lane])) continue;
    const float most = surfaces.specular(t).most_shares(0);
    if (most >= 1 || choice.uniform4(id[lane], batch, 1)[0] < most) on |= 1U << lane;
  }
  return on;
}

void CausticShooter::follow(const Packet& packet, std::vector<float>& power, const Options& options,
                            PhotonCatch& result) const {
  const RayTracer& rays = transport_.rays();
  const SurfaceModel& surfaces = transport_.surface_model();
  const std::size_t bands = transport_.channels().bands();
  const CounterRng choice(seed_, RngPurpose::kCaustic);
  SpecularStep step(bands);
  const auto keep = [&](CausticPhotons& photons, const Vec3f& place, const Vec3f& normal, TriangleId face) {
    photons.places.push_back(place);
    photons.normals.push_back(normal);
    photons.triangles.push_back(face);
    photons.luminaires.push_back(packet.luminaire);
    photons.power.insert(photons.power.end(), power.begin(), power.end());
  };
  Vec3f from = packet.origin;
  Vec3f along = packet.direction;
  TriangleId body;
  bool bent = false;
  for (std::uint32_t n = 0; n < kMostSteps; ++n) {
    Hit hit;
    const bool met = rays.closest(from, along, hit);
    const TriangleId around = met ? surfaces.body_around(hit.triangle, hit.front, body) : TriangleId();
    if (bent && options.sheets != nullptr) {
      const float length = met ? hit.distance : std::numeric_limits<float>::infinity();
      for (const AirSheets::Crossing& at : options.sheets->crossings(from, along, length, options.reach)) {
        keep(result.in_air, from + at.distance * along, options.sheets->normal(at.sheet),
             TriangleId(at.sheet));
        surfaces.attenuate(around, at.distance,
                           result.in_air.power.data() + result.in_air.power.size() - bands);
      }
    }
    if (!met || !transport_.mesh().has_zones(hit.triangle, hit.front)) return;
    surfaces.attenuate(around, hit.distance, power.data());
    const SurfacePoint x = surface_point(rays, hit, along);
    if (bent && takes_light(surfaces, hit))
      keep(result.on_surfaces, from + hit.distance * along, x.normal, hit.triangle);
    if (!is_mirror(surfaces, hit.triangle, hit.front)) return;
    if (n >= kMostStepsInGlass && !hit.front && surfaces.specular(hit.triangle).is_body()) return;
    const std::array<float, 4> u = choice.uniform4(packet.id, packet.batch, n + 1);
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
