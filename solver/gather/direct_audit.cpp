#include "solver/gather/direct_audit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <numeric>

#include <tbb/parallel_for.h>

#include "scenes/model/error.h"
#include "solver/gather/luminaire_packets.h"
#include "solver/gather/replicate_gather.h"
#include "solver/gather/small_zones.h"
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

/// Zones whose direct light is that of packets, or of which packets can be shot anew.
std::vector<ZoneId> zones_to_compare(const Solution& solution) {
  if (solution.record.gathered_zones > 0 && !LuminairePackets::are_shot_for(solution))
    return zones_left_to_packets(solution.mesh);
  std::vector<ZoneId> zones;
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) zones.emplace_back(z);
  return zones;
}

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

/// The zones that are compared, and what is found on them.
class Comparison {
 public:
  Comparison(const Room& room, const Solution& solution, const DirectAuditSettings& settings,
             const std::function<void(double)>& progress, const std::atomic<bool>& interrupt)
      : room_(room),
        mesh_(solution.mesh),
        settings_(settings),
        progress_(progress),
        interrupt_(interrupt),
        zones_(zones_to_compare(solution)),
        light_(room),
        packets_(room, solution, interrupt),
        // P(count - mean >= k sqrt(mean) + k^2/3) <= exp(-k^2/2), and the same below [BLM13, cor. 2.11].
        k_(std::sqrt(2 * std::log(2 * static_cast<double>(std::max<std::size_t>(1, zones_.size())) /
                                  settings.false_alarm))),
        found_(zones_.size()) {}

  void compare() {
    std::vector<std::size_t> suspects(zones_.size());
    std::iota(suspects.begin(), suspects.end(), std::size_t{0});
    compare(suspects, settings_.points, settings_.seed, {0, 0.8});
    // Where a luminaire shows in a thousandth of a zone only, few points may all miss that and know of no
    // error.
    std::erase_if(suspects, [&](std::size_t i) { return !found_[i].difference.differs(); });
    const std::size_t times = kMostZonesAgain / std::max<std::size_t>(1, suspects.size());
    const auto points_again = static_cast<int>(std::min<std::size_t>(
        std::clamp<std::size_t>(times, 4, 64) * static_cast<std::size_t>(settings_.points), 1 << 24));
    compare(suspects, points_again, settings_.seed + 1, {0.8, 1});
  }

  DirectAudit result() const {
    DirectAudit audit;
    audit.left_out = mesh_.zone_count() - zones_.size();
    audit.surfaces.resize(room_.surfaces().surface_count());
    std::vector<double> variances(audit.surfaces.size(), 0.0);  // of SurfaceDirect::by_samples
    for (const auto& [d, variance] : found_) {
      if (!d.zone.valid()) continue;
      const double area = mesh_.zone_area(d.zone);
      const std::size_t s = mesh_.zone_surface(d.zone).index();
      ++audit.compared;
      audit.surfaces[s].by_packets += area * d.by_packets;
      audit.surfaces[s].by_samples += area * d.by_samples;
      variances[s] += area * area * variance;
      if (d.differs()) audit.different.push_back(d);
    }
    for (std::size_t s = 0; s < audit.surfaces.size(); ++s)
      audit.surfaces[s].limit =
          limit(audit.surfaces[s].by_samples, variances[s], packets_.watts_per_packet(SurfaceId(s)));
    const auto power = [&](const DirectDifference& d) {
      return mesh_.zone_area(d.zone) * std::abs(d.by_packets - d.by_samples);
    };
    std::stable_sort(
        audit.different.begin(), audit.different.end(),
        [&](const DirectDifference& a, const DirectDifference& b) { return power(a) > power(b); });
    return audit;
  }

 private:
  struct Found {
    DirectDifference difference;
    double variance = 0;  // of by_samples
  };
  /// Parts of the whole work [0,1].
  struct ProgressRange {
    double begin, end;
  };

  /// What chance explains of a mean that comes in packets of `per_packet`, with a variance of the samples on
  /// top.
  double limit(double mean, double variance, double per_packet) const {
    const double packets = mean / per_packet;
    return per_packet * (k_ * std::sqrt(packets + variance / (per_packet * per_packet)) + k_ * k_ / 3 +
                         kRounding * packets);
  }

  /// A strip of sky over the sill of a far window shows in a few of ten thousand points, which all may miss:
  /// Bernstein's second term for them. Zones are not looked at again for its sake.
  double of_what_points_miss(int points) const {
    return points > settings_.points ? k_ * k_ / 3 * packets_.largest_sky_irradiance() / points : 0;
  }

  void compare(std::size_t i, int points, std::uint64_t seed) {
    const ZoneId zone = zones_[i];
    const ReplicateMean samples = sampled_irradiance(light_, room_, zone, points, seed);
    const double per_packet = packets_.watts_per_packet(zone) / mesh_.zone_area(zone);
    found_[i] = {{zone, packets_.irradiance(zone), samples.mean,
                  limit(samples.mean, samples.squared_error, per_packet) + of_what_points_miss(points)},
                 samples.squared_error};
  }

  void compare(const std::vector<std::size_t>& which, int points, std::uint64_t seed, ProgressRange range) {
    std::mutex mutex;
    std::size_t done = 0;
    const std::size_t chunks = (which.size() + kComparedPerTask - 1) / kComparedPerTask;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
      const std::size_t last = std::min(which.size(), (c + 1) * kComparedPerTask);
      for (std::size_t j = c * kComparedPerTask; j < last && !interrupt_; ++j)
        compare(which[j], points, seed);
      if (!progress_) return;
      const std::lock_guard lock(mutex);
      done += last - c * kComparedPerTask;
      progress_(range.begin +
                (range.end - range.begin) * static_cast<double>(done) / static_cast<double>(which.size()));
    });
  }

  const Room& room_;
  const ZoneMesh& mesh_;
  const DirectAuditSettings& settings_;
  const std::function<void(double)>& progress_;
  const std::atomic<bool>& interrupt_;
  std::vector<ZoneId> zones_;
  DirectLight light_;
  LuminairePackets packets_;
  double k_;
  std::vector<Found> found_;
};

}  // namespace

DirectAudit audit_direct_light(const Room& room, const Solution& solution,
                               const DirectAuditSettings& settings,
                               const std::function<void(double)>& progress,
                               const std::atomic<bool>& interrupt) {
  if (solution.record.packets == 0 || solution.sums.batches == 0)
    throw InputError("solution", "it holds no packets whose first hits could be compared",
                     "solve the room with --method shooting or walk");
  Comparison comparison(room, solution, settings, progress, interrupt);
  if (interrupt) return {};
  comparison.compare();
  return comparison.result();
}

bool DirectAudit::agrees() const {
  return different.empty() &&
         std::none_of(surfaces.begin(), surfaces.end(), [](const SurfaceDirect& s) { return s.differs(); });
}

}  // namespace reemit
