#include "solver/tally/batch_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace reemit {

void add_batch(const ZoneMesh& mesh, const BatchBooks& books, const std::vector<double>& watts_per_quantum,
               ZoneSums& sums) {
  const std::size_t bands = books.bands;
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

ZoneError zone_error(const Scene& scene, const ZoneMesh& mesh, const ZoneSums& sums, bool with_percentile) {
  const std::size_t bands = scene.bands.count();
  const auto n = static_cast<double>(sums.batches);
  ZoneError result;
  if (sums.batches < 2) {
    result.rms = std::numeric_limits<double>::infinity();
    result.percentile_95 = result.rms;
    return result;
  }
  constexpr std::size_t kChunk = 4096;
  const std::size_t zones = mesh.zone_count();
  const std::size_t chunks = (zones + kChunk - 1) / kChunk;
  // Partial sums of fixed chunks, added in order: the same bits on any number of threads.
  std::vector<double> noise(chunks * bands);
  std::vector<double> signal(chunks * bands);
  std::vector<std::uint64_t> unreached(chunks);
  std::vector<float> relative(with_percentile ? zones * bands : 0);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    for (std::size_t z = chunk * kChunk; z < std::min(zones, (chunk + 1) * kChunk); ++z) {
      const double area = mesh.zone_area(ZoneId(z));
      const Spectrum& rho =
          scene.material_of(scene.surfaces[mesh.zone_surface(ZoneId(z)).index()]).reflectance;
      bool reached = false;
      for (std::size_t b = 0; b < bands; ++b) {
        const std::size_t i = z * bands + b;
        const double total = sums.direct[i] + sums.indirect[i];
        if (total == 0) continue;
        reached = true;
        const double variance = std::max(0.0, sums.total_squared[i] - total * total / n) / (n * (n - 1));
        const double r = rho[static_cast<Eigen::Index>(b)];
        noise[chunk * bands + b] += area * r * r * variance;
        signal[chunk * bands + b] += area * r * r * (total / n) * (total / n);
        if (with_percentile) relative[i] = static_cast<float>(std::sqrt(variance) * n / total);
      }
      if (!reached) ++unreached[chunk];
    }
  });
  for (const std::uint64_t u : unreached) result.unreached += u;
  for (std::size_t b = 0; b < bands; ++b) {
    double noise_sum = 0;
    double signal_sum = 0;
    for (std::size_t c = 0; c < chunks; ++c) {
      noise_sum += noise[c * bands + b];
      signal_sum += signal[c * bands + b];
    }
    if (signal_sum > 0) result.rms = std::max(result.rms, std::sqrt(noise_sum / signal_sum));
    if (!with_percentile) continue;
    std::vector<float> lit;
    for (std::size_t i = b; i < relative.size(); i += bands)
      if (sums.direct[i] + sums.indirect[i] > 0) lit.push_back(relative[i]);
    if (lit.empty()) continue;
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), at, lit.end());
    result.percentile_95 = std::max(result.percentile_95, static_cast<double>(*at));
  }
  return result;
}

}  // namespace reemit
