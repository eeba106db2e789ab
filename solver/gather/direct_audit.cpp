#include "solver/gather/direct_audit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <numeric>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "solver/gather/replicate_gather.h"
#include "solver/gather/small_zones.h"
#include "solver/shoot/packet_batch.h"
#include "solver/tally/replicates.h"

namespace reemit {
namespace {

constexpr int kAuditReplicates = 32;
constexpr std::size_t kComparedPerTask = 64;
/// Zones that differ are looked at once more, with 64 times the points or, where many do, with as many times
/// as cost about so many zones in all, and at least 4.
constexpr std::size_t kMostZonesAgain = 262144;
/// What float arithmetic and the drawing of ray starts towards the middle of their triangles may shift.
constexpr double kRounding = 0.003;

/// Whether the direct light of the solution may be that of shadow rays.
bool may_be_sampled(const Solution& solution) {
  const SolverSettings& settings = solution.settings;
  return settings.method == SolveMethod::kShooting && settings.direct == DirectSource::kBest;
}

/// Zones whose direct light is that of packets, or of which packets can be shot anew.
std::vector<ZoneId> zones_to_compare(const Solution& solution) {
  if (solution.record.gathered_zones > 0 && !may_be_sampled(solution))
    return zones_left_to_packets(solution.mesh);
  std::vector<ZoneId> zones;
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) zones.emplace_back(z);
  return zones;
}

/// Irradiance that packets brought to zones straight from luminaires, all bands together [W/m2].
class PacketsOfLuminaires {
 public:
  /// Shoots as many as the solution has, where its direct light may be that of shadow rays.
  PacketsOfLuminaires(const Room& room, const Solution& solution, const std::atomic<bool>& interrupt)
      : solution_(solution) {
    if (may_be_sampled(solution))
      tbb::task_arena().execute([&] { shoot(room, interrupt); });
    else
      packets_ = static_cast<double>(solution.record.packets);
  }

  double count() const { return packets_; }
  double irradiance(ZoneId zone) const {
    if (!shot_.empty()) return shot_[zone.index()];
    double sum = 0;
    for (std::size_t b = 0; b < solution_.bands.count(); ++b)
      sum += solution_.direct_irradiance(zone, b).mean;
    return sum;
  }

 private:
  static constexpr std::uint64_t kPacketsPerBatch = std::uint64_t{1} << 22;

  void shoot(const Room& room, const std::atomic<bool>& interrupt) {
    const PacketRoom transport(room, Channels(solution_.bands.count()));
    const PacketSources emission = collect_packet_sources(transport);
    const StopToken stop(interrupt);
    const std::uint64_t wanted = solution_.record.packets;
    const std::uint64_t batches = (wanted + kPacketsPerBatch - 1) / kPacketsPerBatch;
    const std::size_t bands = emission.channels.count();
    shot_.assign(transport.zones(), 0.0);
    BatchBooks books = transport.new_books();
    for (std::uint64_t k = 0; k < batches && !interrupt; ++k) {
      books.clear();
      shoot_first_flight({transport, emission, solution_.settings, static_cast<std::uint32_t>(k),
                          static_cast<std::uint32_t>(wanted / batches), &stop},
                         books);
      packets_ += static_cast<double>(books.packets);
      for (std::size_t z = 0; z < shot_.size(); ++z)
        for (std::size_t b = 0; b < bands; ++b)
          shot_[z] += static_cast<double>(books.direct[z * bands + b]) * emission.watts_per_quantum[b] /
                      (room.mesh().zone_area(ZoneId(z)) * static_cast<double>(batches));
    }
  }

  const Solution& solution_;
  double packets_ = 0;
  std::vector<double> shot_;  // by zone; empty: those of the solution
};

/// Mean over a zone of the irradiance from sampled luminaires, all bands together, and its standard error
/// [W/m2].
ReplicateMean sampled_irradiance(const DirectLight& light, const Room& room, ZoneId zone, int points,
                                 std::uint64_t seed) {
  const int per_replicate = (points + kAuditReplicates - 1) / kAuditReplicates;
  const auto log2_points = std::countr_zero(std::bit_ceil(static_cast<unsigned>(per_replicate)));
  const std::vector<float> weight(light.band_count(), 1.0F / static_cast<float>(per_replicate));
  std::vector<float> found(light.band_count());
  return mean_of_replicates(kAuditReplicates, kAuditReplicates, [&](std::size_t r) {
    const PointSampler sampler(seed, RngPurpose::kDirectAudit, zone.index(), static_cast<int>(r),
                               log2_points);
    std::fill(found.begin(), found.end(), 0.0F);
    for (int i = 0; i < per_replicate; ++i)
      light.add_sample(point_in_zone(room, zone, sampler.place(i)), sampler.light(i, 0, 1), weight.data(),
                       found.data());
    return static_cast<double>(std::reduce(found.begin(), found.end()));
  });
}

}  // namespace

DirectAudit audit_direct_light(const Room& room, const Solution& solution,
                               const DirectAuditSettings& settings,
                               const std::function<void(double)>& progress,
                               const std::atomic<bool>& interrupt) {
  if (solution.record.packets == 0 || solution.sums.batches == 0)
    throw InputError("solution", "it holds no packets whose first hits could be compared",
                     "solve the room with --method shooting or walk");
  const ZoneMesh& mesh = solution.mesh;
  const std::vector<ZoneId> zones = zones_to_compare(solution);
  const DirectLight light(room);

  const double emitted =
      std::transform_reduce(solution.audit.bands.begin(), solution.audit.bands.end(), 0.0, std::plus<>(),
                            [&](const BandAudit& band) { return solution.audit.watts(band, band.emitted); });
  const PacketsOfLuminaires of_luminaires(room, solution, interrupt);
  if (interrupt) return {};
  const double watts_per_packet = emitted / of_luminaires.count();
  // P(count - mean >= k sqrt(mean) + k^2/3) <= exp(-k^2/2), and the same below [BLM13, cor. 2.11].
  const double k = std::sqrt(
      2 * std::log(2 * static_cast<double>(std::max<std::size_t>(1, zones.size())) / settings.false_alarm));

  // What chance explains of a mean number of packets, with a variance of the samples on top, both in packets.
  const auto chance = [&](double packets, double variance) {
    return k * std::sqrt(packets + variance) + k * k / 3 + kRounding * packets;
  };

  struct Found {
    DirectDifference difference;
    double variance = 0;  // of by_samples
    bool differs() const {
      return std::abs(difference.by_packets - difference.by_samples) > difference.limit;
    }
  };
  std::vector<Found> found(zones.size());
  const auto compare = [&](std::size_t i, int points, std::uint64_t seed) {
    DirectDifference& d = found[i].difference;
    d.by_packets = of_luminaires.irradiance(zones[i]);
    const ReplicateMean samples = sampled_irradiance(light, room, zones[i], points, seed);
    const double per_packet = watts_per_packet / mesh.zone_area(zones[i]);
    d.by_samples = samples.mean;
    d.limit =
        per_packet * chance(samples.mean / per_packet, samples.squared_error / (per_packet * per_packet));
    d.zone = zones[i];
    found[i].variance = samples.squared_error;
  };
  const auto compare_all = [&](const std::vector<std::size_t>& which, int points, std::uint64_t seed,
                               double done_before, double done_after) {
    std::mutex mutex;
    std::size_t done = 0;
    const std::size_t chunks = (which.size() + kComparedPerTask - 1) / kComparedPerTask;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
      const std::size_t last = std::min(which.size(), (c + 1) * kComparedPerTask);
      for (std::size_t j = c * kComparedPerTask; j < last && !interrupt; ++j) compare(which[j], points, seed);
      if (!progress) return;
      const std::lock_guard lock(mutex);
      done += last - c * kComparedPerTask;
      progress(done_before +
               (done_after - done_before) * static_cast<double>(done) / static_cast<double>(which.size()));
    });
  };
  std::vector<std::size_t> suspects(zones.size());
  std::iota(suspects.begin(), suspects.end(), std::size_t{0});
  compare_all(suspects, settings.points, settings.seed, 0, 0.8);
  // Where a luminaire shows in a thousandth of a zone only, few points may all miss that and know of no
  // error.
  std::erase_if(suspects, [&](std::size_t i) { return !found[i].differs(); });
  const std::size_t times = kMostZonesAgain / std::max<std::size_t>(1, suspects.size());
  const auto points_again = static_cast<int>(std::min<std::size_t>(
      std::clamp<std::size_t>(times, 4, 64) * static_cast<std::size_t>(settings.points), 1 << 24));
  compare_all(suspects, points_again, settings.seed + 1, 0.8, 1);

  DirectAudit audit;
  audit.left_out = mesh.zone_count() - zones.size();
  audit.surfaces.resize(room.surfaces().surface_count());
  std::vector<double> variances(room.surfaces().surface_count(), 0.0);  // of SurfaceDirect::by_samples
  for (const auto& [d, variance] : found) {
    if (!d.zone.valid()) continue;
    const double area = mesh.zone_area(d.zone);
    const std::size_t s = mesh.zone_surface(d.zone).index();
    ++audit.compared;
    audit.surfaces[s].by_packets += area * d.by_packets;
    audit.surfaces[s].by_samples += area * d.by_samples;
    variances[s] += area * area * variance;
    if (std::abs(d.by_packets - d.by_samples) > d.limit) audit.different.push_back(d);
  }
  for (std::size_t s = 0; s < audit.surfaces.size(); ++s)
    audit.surfaces[s].limit = watts_per_packet * chance(audit.surfaces[s].by_samples / watts_per_packet,
                                                        variances[s] / (watts_per_packet * watts_per_packet));
  const auto power = [&](const DirectDifference& d) {
    return mesh.zone_area(d.zone) * std::abs(d.by_packets - d.by_samples);
  };
  std::stable_sort(audit.different.begin(), audit.different.end(),
                   [&](const DirectDifference& a, const DirectDifference& b) { return power(a) > power(b); });
  return audit;
}

bool DirectAudit::agrees() const {
  return different.empty() &&
         std::none_of(surfaces.begin(), surfaces.end(), [](const SurfaceDirect& s) { return s.differs(); });
}

}  // namespace reemit
