#include "solver/gather/small_zones.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/replicate_gather.h"
#include "solver/solution/mean_light.h"
#include "solver/tally/batch_statistics.h"
#include "solver/tally/replicates.h"

namespace reemit {
namespace {

constexpr std::size_t kReplicates = ZoneSums::kGroups;
/// A zone is small when it would meet this many times fewer packets than the mean zone.
constexpr double kFewerPackets = 9;
/// Variance of packets over that of gathering, as foreseen, from which on a zone is gathered.
constexpr double kWorthwhile = 2;
/// Variance of what was gathered over that of packets, as foreseen, from which on a zone keeps what packets
/// brought, and standard errors of their difference. A bright spot that few gather rays meet does either: it
/// is met and makes much noise, or it is missed and leaves none.
constexpr double kMostSurprise = 4;
constexpr double kMostDeviation = 5;
/// Share of the area of a zone that rounding of its corners to single precision may take or add. Packets meet
/// slivers as they are rounded, up to a thousand times as often as their area says.
constexpr double kMostRounding = 0.1;
/// Zones get more points than needed, up to so many times as many, while they take this share of the work
/// that is allowed.
constexpr double kMostTimesEnough = 32;
constexpr double kCheap = 0.25;
/// Points per replicate that a zone gets at least: the smallest zones first if not all can have them. Few
/// rays miss a bright spot, and leave no trace of that in the error.
constexpr double kLeastPoints = 8;
/// So many points, half a second's work, may be had by zones that packets do not meet, whatever the limit:
/// sensors in a large room. In a very short run, which knows nothing well, so many times its work.
constexpr double kMostPointsAtAnyCost = 32768;
constexpr double kMostTimesTheRun = 8;
/// Gather rays per shadow ray.
constexpr int kGathersPerPoint = 2;
constexpr std::uint64_t kRaysPerPoint = kReplicates * (1 + kGathersPerPoint);
/// What a point costs in all replicates, in rays of packets: a shadow ray as much as six, weighing one
/// luminaire for it as much as one and a half, a gather ray as much as two.
double cost_per_point(std::size_t luminaires_weighed) {
  return static_cast<double>(kReplicates) *
         (6 + 1.5 * static_cast<double>(luminaires_weighed) + 2 * kGathersPerPoint);
}
/// Zones of one task; fixed, so that packets of rays are the same for any number of threads.
constexpr std::size_t kZonesPerTask = 64;

double mean_zone_area(const ZoneMesh& mesh) {
  double area = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) area += mesh.zone_area(ZoneId(z));
  return area / static_cast<double>(mesh.zone_count());
}

/// Zones that are small, or those that are not, by number.
std::vector<ZoneId> zones_by_size(const ZoneMesh& mesh, bool small) {
  std::vector<ZoneId> zones;
  if (mesh.zone_count() == 0) return zones;
  const double limit = mean_zone_area(mesh) / kFewerPackets;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    if ((mesh.zone_area(ZoneId(z)) < limit) == small) zones.push_back(ZoneId(z));
  return zones;
}

/// Small zones that can be gathered, smallest first. No gather ray leaves the inner side of a body of glass
/// (GatherBatch).
std::vector<ZoneId> small_zones(const Room& room) {
  const ZoneMesh& mesh = room.mesh();
  std::vector<ZoneId> zones = zones_by_size(mesh, true);
  std::erase_if(zones, [&](ZoneId z) {
    return !mesh.zone_is_front(z) && room.surfaces().specular(mesh.zone_triangle(z)).is_body();
  });
  std::stable_sort(zones.begin(), zones.end(),
                   [&](ZoneId a, ZoneId b) { return mesh.zone_area(a) < mesh.zone_area(b); });
  return zones;
}

/// Largest power of two up to this, at least one.
int whole_points(double points) {
  constexpr double kMostPoints = 1 << 16;
  return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(points, 1.0, kMostPoints))));
}

/// The irradiance of one zone in one band without caustics, one value per replicate.
struct ZoneReplicates {
  std::array<double, kReplicates> direct{};
  std::array<double, kReplicates> indirect{};

  ReplicateMean total() const {
    return mean_of_replicates(kReplicates, kReplicates,
                              [&](std::size_t r) { return direct[r] + indirect[r]; });
  }
};

/// Area that can expect so many packets [m2].
double area_of_packets(const Solution& solution, double packets) {
  const ZoneMesh& mesh = solution.mesh;
  return packets * mean_zone_area(mesh) * static_cast<double>(mesh.zone_count()) /
         static_cast<double>(solution.record.rays);
}

/// By zone, 1 where so few packets are to be expected by its area that what they brought says next to
/// nothing. What they did bring has no say, or the lucky zones would be read and the others not.
std::vector<std::uint8_t> little_known_zones(const Solution& solution) {
  constexpr double kFewPackets = 16;
  const ZoneMesh& mesh = solution.mesh;
  const double of_few = area_of_packets(solution, kFewPackets);
  std::vector<std::uint8_t> result(mesh.zone_count());
  for (std::size_t z = 0; z < result.size(); ++z) result[z] = mesh.zone_area(ZoneId(z)) < of_few ? 1 : 0;
  return result;
}

/// What is small stands close to what is large: the part of the floor that a foot sees lies in its shadow,
/// the zone of the floor mostly not. So near hits are continued, and those on uneven zones, unless zones are
/// to send out light evenly, as the matrix method has it. In cavities that packets hardly ever enter all
/// hits are, until light from outside is met.
GatherSettings gather_settings(const SolverSettings& solver, const std::vector<std::uint8_t>& little_known) {
  GatherSettings settings{.most_bounces = 64, .little_known = &little_known, .seed = solver.seed};
  if (solver.reemission == Reemission::kFromZones) settings.close_hit = 0;
  return settings;
}

/// Of PathKey: what foresees whether a zone is worth gathering shares no numbers with what is gathered.
std::uint32_t batch_of(RngPurpose purpose, std::uint32_t replicate) {
  return purpose == RngPurpose::kSmallZonePilot ? static_cast<std::uint32_t>(kReplicates) + replicate
                                                : replicate;
}

/// Gathers at zones; every replicate reads its own part of the zone solution.
class Gatherer {
 public:
  Gatherer(const Room& room, const Solution& solution, const StopToken& stop)
      : room_(room),
        stop_(stop),
        bands_(room.band_count()),
        seed_(solution.settings.seed),
        field_(room, solution, kReplicates),
        direct_(room),
        gather_(field_, direct_, gather_settings(solution.settings, little_known_zones(solution)), &stop) {}
  Gatherer(const Gatherer&) = delete;
  Gatherer& operator=(const Gatherer&) = delete;

  /// Luminaires that the choice of one for a shadow ray looks at.
  std::size_t luminaires_weighed() const { return direct_.luminaires_weighed(); }

  /// Calls use(i, ZoneReplicates by band) for the zones i of the list from any thread; returns how many zones
  /// it was called for.
  template <class Use>
  std::size_t gather(const std::vector<ZoneId>& zones, int points, RngPurpose purpose, Use&& use) const {
    const std::size_t chunks = (zones.size() + kZonesPerTask - 1) / kZonesPerTask;
    std::atomic<std::size_t> gathered{0};
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
      if (stop_.requested()) return;
      const std::size_t last = std::min((c + 1) * kZonesPerTask, zones.size());
      if (gather_chunk(zones, c * kZonesPerTask, last, points, purpose, use))
        gathered += last - c * kZonesPerTask;
    });
    return gathered;
  }

 private:
  /// False if it was told to stop: then it has called use() for none of them.
  template <class Use>
  bool gather_chunk(const std::vector<ZoneId>& zones, std::size_t first, std::size_t last, int points,
                    RngPurpose purpose, Use&& use) const {
    // Per zone and replicate: direct irradiance, then mean reflected radiance over the hemisphere.
    const std::size_t stride = 2 * bands_;
    std::vector<float> found((last - first) * kReplicates * stride, 0.0F);
    std::vector<float> caustic(bands_, 0.0F);
    GatherBatch batch(gather_, kGathersPerPoint);
    float* next = found.data();
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t r = 0; r < kReplicates; ++r, next += stride) {
        if (stop_.requested()) return false;
        const auto replicate = static_cast<std::uint32_t>(r);
        const PointSampler sampler(seed_, purpose, zones[i].index(), static_cast<int>(r),
                                   std::countr_zero(static_cast<unsigned>(points)));
        const auto place = [&](const std::array<float, 2>& u) { return point_in_zone(room_, zones[i], u); };
        add_replicate(direct_, sampler, {points, kGathersPerPoint},
                      {zones[i].index(), batch_of(purpose, replicate), 0, replicate}, place, batch, next,
                      next + bands_, caustic.data());
      }
    batch.flush();
    std::vector<ZoneReplicates> by_band(bands_);
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t b = 0; b < bands_; ++b)
        for (std::size_t r = 0; r < kReplicates; ++r) {
          const float* values = &found[((i - first) * kReplicates + r) * stride];
          by_band[b].direct[r] = static_cast<double>(values[b]);
          by_band[b].indirect[r] = std::numbers::pi * static_cast<double>(values[bands_ + b]);
        }
      use(i, std::as_const(by_band));
    }
    return true;
  }

  const Room& room_;
  const StopToken& stop_;
  std::size_t bands_;
  std::uint64_t seed_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
};

/// What was gathered on a zone, all bands together, caustics left out.
struct GatheredLight {
  ReplicateMean brought;  // as far as packets bring it [W/m2]
  double variance = 0;    // of all its irradiance
};

GatheredLight gathered_light(const std::vector<ZoneReplicates>& by_band, bool direct_is_sampled) {
  GatheredLight result;
  for (const ZoneReplicates& x : by_band) {
    const ReplicateMean total = x.total();
    const ReplicateMean brought =
        direct_is_sampled
            ? mean_of_replicates(kReplicates, kReplicates, [&](std::size_t r) { return x.indirect[r]; })
            : total;
    result.brought.mean += brought.mean;
    result.brought.squared_error += brought.squared_error;
    result.variance += total.squared_error;
  }
  return result;
}

/// True if gathering with `gain` times the rays of the pilot is foreseen to beat packets clearly.
bool is_worthwhile(const GatheredLight& pilot, double gain, double area, double watts_per_ray) {
  const double variance_of_packets = pilot.brought.mean * watts_per_ray / area;
  return pilot.variance / gain * kWorthwhile <= variance_of_packets;
}

/// What packets brought to a zone, all bands together, caustics left out.
struct PacketLight {
  double irradiance = 0;      // [W/m2]
  double of_one = 0;          // what a packet brings [W/m2]
  bool area_is_exact = true;  // for rays: no sliver that rounding makes wider

  /// False if packets know better than gather rays.
  bool agree_with(const ReplicateMean& gathered) const {
    const double variance = std::max(irradiance, gathered.mean) * of_one;
    if (gathered.squared_error > kMostSurprise * variance) return false;
    const double deviation = gathered.mean - irradiance;
    return !area_is_exact ||
           deviation * deviation <= kMostDeviation * kMostDeviation * (variance + gathered.squared_error);
  }
};

/// As rays meet it [m2].
double rounded_area(const RayTracer& rays, TriangleId t) {
  const Vec3 corner = rays.corner(t, 0).cast<double>();
  const Vec3 u = rays.corner(t, 1).cast<double>() - corner;
  const Vec3 v = rays.corner(t, 2).cast<double>() - corner;
  return 0.5 * u.cross(v).norm() * rays.metres_per_unit() * rays.metres_per_unit();
}

bool is_exact_for_rays(const Room& room, ZoneId zone) {
  const ZoneMesh& mesh = room.mesh();
  double rounded = 0;
  double exact = 0;
  const std::size_t members = mesh.is_group(zone) ? mesh.member_count(zone) : 1;
  for (std::uint32_t m = 0; m < members; ++m) {
    const TriangleId t = mesh.is_group(zone) ? mesh.member_triangle(zone, m) : mesh.zone_triangle(zone);
    rounded += rounded_area(room.rays(), t);
    exact += mesh.triangle_area(t);
  }
  return std::abs(rounded - exact) <= kMostRounding * exact;
}

PacketLight packet_light(const Room& room, const Solution& solution, ZoneId zone, bool direct_is_sampled,
                         double watts_per_ray) {
  PacketLight result{0, watts_per_ray / room.mesh().zone_area(zone), is_exact_for_rays(room, zone)};
  for (std::size_t b = 0; b < solution.bands.count(); ++b)
    result.irradiance += solution.indirect_irradiance(zone, b).mean +
                         (direct_is_sampled ? 0.0 : solution.direct_irradiance(zone, b).mean);
  return result;
}

/// One gather of small zones: a pilot of all, the choice of those that it is worthwhile for, and their
/// gather.
class SmallZoneRun {
 public:
  SmallZoneRun(const Room& room, const SmallZoneLimits& limits, Solution& solution, const StopToken& stop)
      : room_(room),
        limits_(limits),
        solution_(solution),
        gatherer_(room, solution, stop),
        packet_rays_(static_cast<double>(solution.record.rays)),
        watts_per_ray_(incident_power_per_ray(solution, limits.direct_is_sampled
                                                            ? &Solution::indirect_irradiance
                                                            : &Solution::irradiance)
                           .sum()),
        affordable_(limits.solver_rays / cost_per_point(gatherer_.luminaires_weighed())) {}

  /// True if the clock had a say in what was gathered.
  bool run(std::vector<ZoneId> zones) {
    const double of_run = packet_rays_ / cost_per_point(gatherer_.luminaires_weighed());
    affordable_ = std::max(
        affordable_, std::min({kMostPointsAtAnyCost, kMostTimesTheRun * of_run, points_of_hopeless(zones)}));
    // A pilot takes one point per replicate; the smallest zones first if not all can have more than that.
    zones.resize(std::min(zones.size(), static_cast<std::size_t>(affordable_ / 3)));
    if (zones.empty()) return false;
    std::vector<GatheredLight> pilots(zones.size());
    if (!pilot(zones, pilots)) return true;
    choose(zones, pilots);
    if (chosen_.empty()) return clock_had_a_say_;
    const std::size_t gathered = gather();
    return clock_had_a_say_ || gathered < chosen_.size();
  }

 private:
  /// Points for those that packets will not meet even once, by their area; smallest zones come first.
  double points_of_hopeless(const std::vector<ZoneId>& zones) const {
    const double area = area_of_packets(solution_, 1);
    const auto end = std::find_if(zones.begin(), zones.end(),
                                  [&](ZoneId z) { return solution_.mesh.zone_area(z) >= area; });
    return (1 + kLeastPoints) * static_cast<double>(end - zones.begin());
  }

  /// Sets how many points are left. False if it was cut off.
  bool pilot(const std::vector<ZoneId>& zones, std::vector<GatheredLight>& pilots) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t piloted =
        gatherer_.gather(zones, 1, RngPurpose::kSmallZonePilot,
                         [&](std::size_t i, const std::vector<ZoneReplicates>& by_band) {
                           pilots[i] = gathered_light(by_band, limits_.direct_is_sampled);
                         });
    count_rays(piloted * kRaysPerPoint);
    if (piloted < zones.size()) return false;
    points_left_ = affordable_ - static_cast<double>(piloted);
    if (!limits_.seconds) return true;
    // The pilot has shown how long a point takes.
    const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double in_time = (*limits_.seconds / spent - 1) * static_cast<double>(piloted);
    clock_had_a_say_ = in_time < points_left_;
    points_left_ = std::min(points_left_, in_time);
    return true;
  }

  void choose(const std::vector<ZoneId>& zones, const std::vector<GatheredLight>& pilots) {
    const double gain = whole_points(points_left_ / static_cast<double>(zones.size()));
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (!is_worthwhile(pilots[i], gain, solution_.mesh.zone_area(zones[i]), watts_per_ray_)) continue;
      chosen_.push_back(zones[i]);
      packets_.push_back(packet_light(room_, solution_, zones[i], limits_.direct_is_sampled, watts_per_ray_));
    }
    chosen_.resize(
        std::min(chosen_.size(), static_cast<std::size_t>(std::max(0.0, points_left_ / kLeastPoints))));
  }

  int points_per_replicate() const {
    // As many rays as the mean zone meets packets leave about its error. But few shadow rays find a window,
    // and zones that are few are sensors: more cost next to nothing then.
    const auto count = static_cast<double>(chosen_.size());
    const double enough = std::max(
        kLeastPoints, packet_rays_ / static_cast<double>(solution_.mesh.zone_count() * kRaysPerPoint));
    const double cheap = std::min(kMostTimesEnough * enough, kCheap * affordable_ / count);
    return whole_points(std::min(std::max(enough, cheap), points_left_ / count));
  }

  /// Returns how many of the chosen zones it came to.
  std::size_t gather() {
    const int points = points_per_replicate();
    const std::size_t bands = room_.band_count();
    solution_.gathered.keep(solution_.sums, chosen_);
    std::atomic<std::size_t> surprises{0};
    const std::size_t gathered = gatherer_.gather(
        chosen_, points, RngPurpose::kSmallZone,
        [&](std::size_t i, const std::vector<ZoneReplicates>& by_band) {
          if (!packets_[i].agree_with(gathered_light(by_band, limits_.direct_is_sampled).brought)) {
            ++surprises;
            return;
          }
          for (std::size_t b = 0; b < bands; ++b)
            store_replicates(solution_.sums, chosen_[i].index() * solution_.sums.channels.count() + b,
                             by_band[b].direct, by_band[b].indirect);
        });
    solution_.record.gathered_zones = gathered - surprises;
    count_rays(gathered * kRaysPerPoint * static_cast<std::uint64_t>(points));
    return gathered;
  }

  void count_rays(std::uint64_t rays) {
    solution_.gathered.rays += rays;
    solution_.record.rays += rays;
  }

  const Room& room_;
  const SmallZoneLimits& limits_;
  Solution& solution_;
  Gatherer gatherer_;
  double packet_rays_;    // of the solve
  double watts_per_ray_;  // of them
  double affordable_;     // points per replicate of all zones together
  double points_left_ = 0;
  bool clock_had_a_say_ = false;
  std::vector<ZoneId> chosen_;
  std::vector<PacketLight> packets_;  // of each
};

}  // namespace

std::size_t small_zone_count(const ZoneMesh& mesh) {
  return zones_by_size(mesh, true).size();
}

std::vector<ZoneId> zones_left_to_packets(const ZoneMesh& mesh) {
  return zones_by_size(mesh, false);
}

bool gather_small_zones(const Room& room, const SmallZoneLimits& limits, Solution& solution,
                        const StopToken& stop) {
  if (solution.sums.batches < static_cast<std::int64_t>(kReplicates)) return false;
  std::vector<ZoneId> zones = small_zones(room);
  if (zones.empty()) return false;
  solution.gathered.rays = 0;
  return SmallZoneRun(room, limits, solution, stop).run(std::move(zones));
}

}  // namespace reemit
