#include "solver/gather/zone_bias_estimate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/point_sampler.h"
#include "solver/gather/replicate_gather.h"
#include "solver/gather/zone_probes.h"
#include "solver/tally/replicates.h"

namespace reemit {
namespace {

constexpr std::uint32_t kBiasReplicates = 16;
static_assert(kBiasReplicates == ZoneSums::kGroups);

/// Adds the difference at one point of one replicate to sum[b].
void add_difference(const HemisphereGather& gather, const PathTracer& path, const SurfacePoint& x,
                    const PointSampler& sampler, std::uint32_t rays, PathKey key, float* sum) {
  const std::size_t bands = gather.band_count();
  SurfaceModel::PointValues at_point;
  const float* reflectance = gather.room().surfaces().reflectance(x, at_point);
  std::vector<float> plus(bands);
  std::vector<float> minus(bands);
  GatherBatch batch(gather);
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    const std::array<float, 2> u = sampler.hemisphere(static_cast<int>(ray), 0, 1);
    key.path = ray;
    for (std::size_t b = 0; b < bands; ++b) {
      plus[b] = reflectance[b] / static_cast<float>(rays);
      minus[b] = -plus[b];
    }
    batch.add(x, u[0], u[1], key, plus.data(), sum);
    path.add_indirect(x, u[0], u[1], key, minus.data(), sum);
  }
  batch.flush();
}

/// Square of the mean, the least that leaving out one of them makes it.
double square_without_one(const std::array<double, kBiasReplicates>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (const double value : values)
    least = std::min(least, std::pow((sum - value) / (kBiasReplicates - 1), 2));
  return least;
}

}  // namespace

ZoneBiasEffort ZoneBiasEffort::of(double rays) {
  // A gathered and traced ray costs about as much as ten rays.
  constexpr double kShare = 500;
  constexpr double kMostRays = 1 << 12;
  const double of_point = std::clamp(rays / (kShare * kPoints), double{kBiasReplicates}, kMostRays);
  return {static_cast<std::uint32_t>(of_point) / kBiasReplicates * kBiasReplicates};
}

std::optional<ZoneBias> estimate_zone_bias(const HemisphereGather& gather, const PathTracer& path,
                                           std::span<const SurfacePoint> points,
                                           std::span<const double> scale, const ZoneBiasEffort& effort,
                                           std::uint64_t seed, const StopToken* stop) {
  if (gather.field().has_light_that_rays_miss()) return std::nullopt;
  const std::size_t bands = gather.band_count();
  const std::size_t parts = gather.field().parts();
  const std::uint32_t rays = effort.rays / kBiasReplicates;
  const std::size_t of_point = kBiasReplicates * bands;
  std::vector<float> differences(points.size() * of_point, 0.0F);  // by point, replicate, band
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    for (std::size_t r = 0; r < kBiasReplicates; ++r) {
      if (stop != nullptr && stop->requested()) return;
      const PointSampler sampler(seed, RngPurpose::kZoneBias, i, static_cast<int>(r),
                                 std::countr_zero(std::bit_ceil(rays)));
      const PathKey key{i, static_cast<std::uint32_t>(r), 0, static_cast<std::uint32_t>(r % parts)};
      add_difference(gather, path, points[i], sampler, rays, key, &differences[i * of_point + r * bands]);
    }
  });

  ZoneBias worst;
  for (std::size_t b = 0; b < bands; ++b) {
    double square = 0;
    double variance = 0;      // of `square`
    double without_rare = 0;  // `square`, of each group without one of its replicates
    for (std::size_t g = 0; g < ZoneBiasEffort::kGroups; ++g) {
      const std::size_t first = g * points.size() / ZoneBiasEffort::kGroups;
      const std::size_t last = (g + 1) * points.size() / ZoneBiasEffort::kGroups;
      std::array<double, kBiasReplicates> of_replicate{};
      for (std::size_t r = 0; r < kBiasReplicates; ++r) {
        for (std::size_t i = first; i < last; ++i)
          of_replicate[r] +=
              scale[i * bands + b] * static_cast<double>(differences[i * of_point + r * bands + b]);
        of_replicate[r] /= static_cast<double>(ZoneBiasEffort::kPointsPerGroup);
      }
      const ReplicateMean mean =
          mean_of_replicates(kBiasReplicates, parts, [&](std::size_t r) { return of_replicate[r]; });
      const double error2 = mean.squared_error;
      without_rare += (square_without_one(of_replicate) - error2) / ZoneBiasEffort::kGroups;
      square += (mean.mean * mean.mean - error2) / ZoneBiasEffort::kGroups;
      variance += (4 * mean.mean * mean.mean + 2 * error2) * error2 /
                  (ZoneBiasEffort::kGroups * ZoneBiasEffort::kGroups);
    }
    // Paths that are rare and bright, as those by the circle of a narrow spot, come to one replicate and make
    // up a difference that no other has.
    const double best = without_rare > 0 ? std::max(0.0, square) : 0.0;
    const ZoneBias bias{std::sqrt(best), std::sqrt(std::max(0.0, square) + 2 * std::sqrt(variance))};
    if (bias.bound > worst.bound) worst = bias;
  }
  return worst;
}

std::optional<ZoneBias> estimate_zone_bias(const RadianceField& field, const Solution& solution,
                                           const ZoneBiasEffort& effort, const StopToken& stop) {
  if (stop.requested()) return std::nullopt;
  const std::uint64_t seed = solution.settings.seed;
  const CounterRng rng(seed, RngPurpose::kZoneBias);
  const double offset = static_cast<double>(rng.uniform4(0, kBiasReplicates, 0)[0]);
  const std::vector<ZoneProbe> probes = choose_probes(solution, ZoneBiasEffort::kPoints, offset);
  if (probes.size() < ZoneBiasEffort::kPoints) return std::nullopt;
  const Room& room = field.room();
  const DirectLight direct(room);
  const HemisphereGather gather(
      field, direct, GatherSettings{.aim_at_bright = false, .seed = seed, .plan = &solution.gather_plan},
      &stop);
  if (stop.requested()) return std::nullopt;
  const PathTracer path(room, direct, seed);

  // Probes stand for areas of their own, and their sum is the mean radiance times the area.
  const std::size_t bands = field.band_count();
  std::vector<double> power(bands, 0.0);
  for (const ZoneProbe& probe : probes)
    for (std::size_t b = 0; b < bands; ++b)
      power[b] += probe.area * static_cast<double>(field.mean_reflected(probe.zone, b));
  std::vector<SurfacePoint> points;
  std::vector<double> scale;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::array<float, 4> u = rng.uniform4(i, kBiasReplicates + 1, 0);
    points.push_back(point_in_zone(room, probes[i].zone, {u[0], u[1]}));
    for (const double p : power) scale.push_back(p > 0 ? ZoneBiasEffort::kPoints * probes[i].area / p : 0);
  }
  const std::optional<ZoneBias> bias = estimate_zone_bias(gather, path, points, scale, effort, seed, &stop);
  if (stop.requested()) return std::nullopt;
  return bias;
}

}  // namespace reemit
