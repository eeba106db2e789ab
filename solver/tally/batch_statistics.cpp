#include "solver/tally/batch_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/tally/replicates.h"

namespace reemit {

void add_batch(const ZoneMesh& mesh, const BatchBooks& books, const std::vector<double>& watts_per_quantum,
               ZoneSums& sums) {
  const std::size_t bands = books.bands;
  const auto group = static_cast<std::size_t>(sums.batches) % ZoneSums::kGroups;
  double* group_total = &sums.group_total[group * mesh.zone_count() * bands];
  ++sums.batches;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.zone_count(), 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z) {
      const double per_area = 1.0 / mesh.zone_area(ZoneId(z));
      for (std::size_t b = 0; b < bands; ++b) {
        const std::size_t i = z * bands + b;
        if (books.direct[i] == 0 && books.indirect[i] == 0) continue;
        const double scale = watts_per_quantum[b] * per_area;
        const double direct = static_cast<double>(books.direct[i]) * scale;
        const double indirect = static_cast<double>(books.indirect[i]) * scale;
        sums.direct[i] += direct;
        sums.direct_squared[i] += direct * direct;
        sums.indirect[i] += indirect;
        sums.indirect_squared[i] += indirect * indirect;
        sums.total_squared[i] += (direct + indirect) * (direct + indirect);
        group_total[i] += direct + indirect;
      }
    }
  });
}

void add_batch(const BatchBooks& books, EnergyAudit& audit) {
  ++audit.batches;
  const std::size_t bands = books.bands;
  for (std::size_t b = 0; b < bands; ++b) {
    BandAudit& a = audit.bands[b];
    a.emitted += books.emitted[b];
    a.unshot += books.unshot[b];
    a.roulette_gain += books.roulette_gain[b];
    a.roulette_loss += books.roulette_loss[b];
    for (std::size_t s = 0; s < a.absorbed.size(); ++s) {
      a.absorbed[s] += books.absorbed[s * bands + b];
      a.absorbed_on_backs[s] += books.absorbed_on_backs[s * bands + b];
    }
    for (std::size_t axis = 0; axis < a.escaped.size(); ++axis)
      a.escaped[axis] += books.escaped[axis * bands + b];
    if (a.balance() != 0)
      throw std::logic_error("the energy books of band " + a.band + " are off by " +
                             std::to_string(a.balance()) + " quanta after batch " +
                             std::to_string(audit.batches));
  }
}

void store_replicates(ZoneSums& sums, std::size_t i, std::span<const double> direct,
                      std::span<const double> indirect) {
  const std::size_t count = direct.size();
  const auto n = static_cast<double>(sums.batches);
  // Sums over n batches with the mean and the standard error of the replicates: sum of squares =
  // n (n-1) s^2 + n mean^2.
  const auto store = [&](auto&& value, double& sum, double& squares) {
    const ReplicateMean x = mean_of_replicates(count, count, value);
    const double error2 = count > 1 ? x.squared_error : 0;
    sum = n * x.mean;
    squares = n * (n - 1) * error2 + n * x.mean * x.mean;
  };
  const auto total = [&](std::size_t g) { return direct[g] + indirect[g]; };
  double sum_of_total = 0;
  store([&](std::size_t g) { return direct[g]; }, sums.direct[i], sums.direct_squared[i]);
  store([&](std::size_t g) { return indirect[g]; }, sums.indirect[i], sums.indirect_squared[i]);
  store(total, sum_of_total, sums.total_squared[i]);
  const std::size_t values = sums.direct.size();
  for (std::size_t g = 0; g < count; ++g)
    sums.group_total[g * values + i] = total(g) * static_cast<double>(sums.group_batches(g));
}

namespace {

constexpr std::size_t kChunk = 4096;
constexpr std::size_t kGroups = ZoneSums::kGroups;

/// Sums over zones for one band.
struct BandError {
  double noise = 0;   // sum A rho^2 s^2
  double signal = 0;  // sum A (rho E)^2
  /// Squared distance of each batch group from the mean, in the same unit as noise.
  std::array<double, kGroups> group_noise{};
};

double reflectance_of(const Scene& scene, const ZoneMesh& mesh, std::size_t zone, std::size_t band) {
  const Surface& surface = scene.surfaces[mesh.zone_surface(ZoneId(zone)).index()];
  return scene.material_of(surface).reflectance[static_cast<Eigen::Index>(band)];
}

double variance_of_mean(const ZoneSums& sums, std::size_t i) {
  const auto n = static_cast<double>(sums.batches);
  const double total = sums.direct[i] + sums.indirect[i];
  return std::max(0.0, sums.total_squared[i] - total * total / n) / (n * (n - 1));
}

/// By band. Partial sums of fixed chunks are added in order: the same bits on any number of threads.
std::vector<BandError> band_errors(const Scene& scene, const ZoneMesh& mesh, const ZoneSums& sums,
                                   bool with_groups) {
  const std::size_t bands = scene.bands.count();
  const std::size_t zones = mesh.zone_count();
  const std::size_t values = zones * bands;
  const std::size_t chunks = (zones + kChunk - 1) / kChunk;
  const auto n = static_cast<double>(sums.batches);
  std::vector<BandError> parts(chunks * bands);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for (std::size_t z = chunk * kChunk; z < std::min(zones, (chunk + 1) * kChunk); ++z) {
      const double area = mesh.zone_area(ZoneId(z));
      for (std::size_t b = 0; b < bands; ++b) {
        const std::size_t i = z * bands + b;
        const double mean = (sums.direct[i] + sums.indirect[i]) / n;
        if (mean == 0) continue;
        const double r = reflectance_of(scene, mesh, z, b);
        BandError& part = parts[chunk * bands + b];
        part.noise += area * r * r * variance_of_mean(sums, i);
        part.signal += area * r * r * mean * mean;
        if (!with_groups) continue;
        for (std::size_t g = 0; g < kGroups; ++g) {
          const auto batches = static_cast<double>(sums.group_batches(g));
          if (batches == 0) break;
          const double deviation = sums.group_total[g * values + i] / batches - mean;
          part.group_noise[g] += area * r * r * deviation * deviation;
        }
      }
    }
  });
  std::vector<BandError> result(bands);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    BandError& band = result[p % bands];
    band.noise += parts[p].noise;
    band.signal += parts[p].signal;
    for (std::size_t g = 0; g < kGroups; ++g) band.group_noise[g] += parts[p].group_noise[g];
  }
  return result;
}

double relative_rms(const BandError& band) {
  return band.signal > 0 ? std::sqrt(band.noise / band.signal) : 0.0;
}

/// Relative standard deviation of the squared error of one run. A group is a run of its own, and for errors
/// near to normal this ratio does not depend on the number of batches.
double spread_of_squared_error(const BandError& band, const ZoneSums& sums) {
  const std::size_t groups = std::min<std::size_t>(kGroups, static_cast<std::size_t>(sums.batches));
  constexpr std::size_t kFewestGroups = 8;
  // One normal error, the worst case: its square has standard deviation sqrt(2) times its mean.
  if (groups < kFewestGroups) return std::sqrt(2.0);
  const auto n = static_cast<double>(sums.batches);
  double mean = 0;
  double squares = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    const double expected = 1 / static_cast<double>(sums.group_batches(g)) - 1 / n;
    const double x = band.group_noise[g] / expected;
    const double deviation = x - mean;
    mean += deviation / static_cast<double>(g + 1);
    squares += deviation * (x - mean);
  }
  return mean > 0 ? std::sqrt(squares / static_cast<double>(groups - 1)) / mean : 0.0;
}

/// 95th percentile of s/E over lit zones, and the zones that nothing reached.
void find_percentile(const ZoneSums& sums, std::size_t bands, ZoneError& result) {
  const std::size_t values = sums.direct.size();
  const auto total = [&](std::size_t i) { return sums.direct[i] + sums.indirect[i]; };
  for (std::size_t first = 0; first < values; first += bands) {
    bool reached = false;
    for (std::size_t i = first; i < first + bands; ++i) reached = reached || total(i) > 0;
    if (!reached) ++result.unreached;
  }
  const auto n = static_cast<double>(sums.batches);
  std::vector<float> lit;
  for (std::size_t b = 0; b < bands; ++b) {
    lit.clear();
    for (std::size_t i = b; i < values; i += bands)
      if (total(i) > 0)
        lit.push_back(static_cast<float>(std::sqrt(variance_of_mean(sums, i)) * n / total(i)));
    if (lit.empty()) continue;
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), at, lit.end());
    result.percentile_95 = std::max(result.percentile_95, static_cast<double>(*at));
  }
}

}  // namespace

double zone_rms_error(const Scene& scene, const ZoneMesh& mesh, const ZoneSums& sums) {
  if (sums.batches < 2) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const BandError& band : band_errors(scene, mesh, sums, false))
    worst = std::max(worst, relative_rms(band));
  return worst;
}

ZoneError zone_error(const Scene& scene, const ZoneMesh& mesh, const ZoneSums& sums) {
  constexpr double kSigmas = 3.09;  // one-sided 99.9 % of the normal distribution
  ZoneError result;
  find_percentile(sums, scene.bands.count(), result);
  if (sums.batches < 2) {
    result.rms = result.bound = result.percentile_95 = std::numeric_limits<double>::infinity();
    return result;
  }
  for (const BandError& band : band_errors(scene, mesh, sums, true)) {
    const double rms = relative_rms(band);
    result.rms = std::max(result.rms, rms);
    result.bound = std::max(result.bound, rms * std::sqrt(1 + kSigmas * spread_of_squared_error(band, sums)));
  }
  return result;
}

}  // namespace reemit
