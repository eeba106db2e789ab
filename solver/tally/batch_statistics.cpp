#include "solver/tally/batch_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/solution/opposite_zones.h"
#include "solver/tally/error_bound.h"
#include "solver/tally/replicates.h"

namespace reemit {

void add_batch(const ZoneMesh& mesh, const BatchBooks& books, const std::vector<double>& watts_per_quantum,
               std::int64_t weight, ZoneSums& sums) {
  const std::size_t channels = books.channels.count();
  const auto w = static_cast<double>(weight);
  const bool caustics = sums.has_caustics();
  float* group_total = &sums.group_total[sums.count_batch(weight) * mesh.zone_count() * channels];
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.zone_count(), 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z) {
      const double per_area = 1.0 / mesh.zone_area(ZoneId(z));
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t i = z * channels + c;
        if (books.direct[i] == 0 && books.indirect[i] == 0 && !(caustics && books.caustic[i] != 0)) continue;
        const double scale = w * watts_per_quantum[c] * per_area;
        const double direct = static_cast<double>(books.direct[i]) * scale;
        const double indirect = static_cast<double>(books.indirect[i]) * scale;
        sums.direct[i] += direct;
        sums.direct_cross[i] += w * direct;
        sums.direct_squared[i] += direct * direct;
        sums.indirect[i] += indirect;
        sums.indirect_cross[i] += w * indirect;
        sums.indirect_squared[i] += indirect * indirect;
        double total = direct + indirect;
        if (caustics) {
          const double caustic = static_cast<double>(books.caustic[i]) * scale;
          sums.caustic[i] += caustic;
          sums.caustic_cross[i] += w * caustic;
          sums.caustic_squared[i] += caustic * caustic;
          total += caustic;
        }
        sums.total_squared[i] += total * total;
        group_total[i] += static_cast<float>(total);
      }
    }
  });
}

void add_batch(const BatchBooks& books, std::int64_t weight, EnergyAudit& audit) {
  ++audit.batches;
  audit.weight += weight;
  audit.events += books.events;
  const std::size_t channels = books.channels.count();
  const RunQuanta w = weight;
  for (std::size_t c = 0; c < channels; ++c) {
    BandAudit& a = audit.bands[c];
    a.emitted += w * books.emitted[c];
    a.unshot += w * books.unshot[c];
    a.roulette_net += w * (books.roulette_gain[c] - books.roulette_loss[c]);
    a.roulette_gain += static_cast<double>(weight) * static_cast<double>(books.roulette_gain[c]);
    for (std::size_t s = 0; s < a.absorbed.size(); ++s) {
      a.absorbed[s] += w * books.absorbed[s * channels + c];
      a.absorbed_on_backs[s] += w * books.absorbed_on_backs[s * channels + c];
    }
    for (std::size_t axis = 0; axis < a.escaped.size(); ++axis)
      a.escaped[axis] += w * books.escaped[axis * channels + c];
    if (a.balance() != 0)
      throw std::logic_error("the energy books of band " + a.band + " are off by " +
                             std::to_string(a.balance()) + " quanta after batch " +
                             std::to_string(audit.batches));
  }
}

namespace {

constexpr std::size_t kGroups = ZoneSums::kGroups;

/// The caustic part of one value of the sums.
struct CausticPart {
  double mean = 0;
  double squared_error = 0;
  std::array<double, kGroups> of_group{};  // the mean of a batch group
};

/// Groups are known by their totals only. Those of the caustic part deviate from its mean as these do, as far
/// as its error says.
CausticPart caustic_part(const ZoneSums& sums, std::size_t i) {
  CausticPart part;
  if (!sums.has_caustics() || sums.caustic[i] == 0) return part;
  const auto w = static_cast<double>(sums.weight());
  part.mean = sums.caustic[i] / w;
  part.of_group.fill(part.mean);
  if (sums.batches < 2) return part;
  part.squared_error = sums.squared_error(sums.caustic[i], sums.caustic_cross[i], sums.caustic_squared[i]);
  const double of_total = sums.squared_error(sums.total(i), sums.total_cross(i), sums.total_squared[i]);
  if (!(of_total > 0)) return part;
  const double share = std::sqrt(part.squared_error / of_total);
  for (std::size_t g = 0; g < kGroups; ++g)
    if (sums.group_weight[g] > 0)
      part.of_group[g] += share * (static_cast<double>(sums.group_total[g * sums.direct.size() + i]) /
                                       static_cast<double>(sums.group_weight[g]) -
                                   sums.total(i) / w);
  return part;
}

}  // namespace

void store_replicates(ZoneSums& sums, std::size_t i, std::span<const double> direct,
                      std::span<const double> indirect) {
  const CausticPart caustic = caustic_part(sums, i);
  const std::size_t count = direct.size();
  const auto w = static_cast<double>(sums.weight());
  const auto replicates = [&](auto&& value) {
    ReplicateMean x = mean_of_replicates(count, count, value);
    if (count < 2) x.squared_error = 0;
    return x;
  };
  // The sums that ZoneSums::squared_error gives this mean and this error for.
  const auto squares_of = [&](double mean, double cross, double squared_error) {
    return (w * w - sums.weight_squared) * squared_error + 2 * mean * cross -
           sums.weight_squared * mean * mean;
  };
  const auto store = [&](std::span<const double> value, double& sum, double& cross, double& squares) {
    const ReplicateMean x = replicates([&](std::size_t g) { return value[g]; });
    sum = w * x.mean;
    cross = sums.weight_squared * x.mean;
    squares = squares_of(x.mean, cross, x.squared_error);
  };
  store(direct, sums.direct[i], sums.direct_cross[i], sums.direct_squared[i]);
  store(indirect, sums.indirect[i], sums.indirect_cross[i], sums.indirect_squared[i]);
  const ReplicateMean both = replicates([&](std::size_t g) { return direct[g] + indirect[g]; });
  sums.total_squared[i] =
      squares_of(both.mean + caustic.mean, sums.total_cross(i), both.squared_error + caustic.squared_error);
  const std::size_t values = sums.direct.size();
  for (std::size_t g = 0; g < count; ++g)
    sums.group_total[g * values + i] = static_cast<float>((direct[g] + indirect[g] + caustic.of_group[g]) *
                                                          static_cast<double>(sums.group_weight[g]));
}

namespace {

constexpr std::size_t kChunk = 4096;

/// Sums over zones for one channel.
struct ChannelError {
  double noise = 0;   // sum A s^2
  double signal = 0;  // sum A B^2
  /// Inner products of the deviations of the batch groups from the mean, for largest_error_quotient.
  std::array<double, kGroups * kGroups> products{};
};

double variance_of_mean(const ZoneSums& sums, std::size_t i) {
  return sums.squared_error(sums.total(i), sums.total_cross(i), sums.total_squared[i]);
}

std::size_t groups_with_batches(const ZoneSums& sums) {
  return std::min(kGroups, static_cast<std::size_t>(sums.batches));
}

/// Irradiance that a zone sends on: its own by reflection, that of zones behind it by transmission.
struct SentOn {
  std::size_t value;  // of the sums
  double mean;        // [W/m2]
  double share;
};

/// Adds the inner products of what a zone sends out to the upper half of the table.
void add_products(const ZoneSums& sums, const std::vector<SentOn>& sent, double area, ChannelError& part) {
  const std::size_t groups = groups_with_batches(sums);
  std::array<double, kGroups> deviation{};
  for (std::size_t g = 0; g < groups; ++g) {
    const auto w = static_cast<double>(sums.group_weight[g]);
    for (const SentOn& light : sent) {
      const auto total = static_cast<double>(sums.group_total[g * sums.direct.size() + light.value]);
      deviation[g] += light.share * (total / w - light.mean) * std::sqrt(w);
    }
  }
  for (std::size_t g = 0; g < groups; ++g)
    for (std::size_t h = g; h < groups; ++h)
      part.products[g * groups + h] += area * deviation[g] * deviation[h];
}

/// What errors are those of.
enum class ErrorOf { kScatteredLight, kIrradiance };

/// The zones behind one whose light comes through it diffusely, and what does, by band; empty of others.
struct Behind {
  std::vector<ZoneShare> zones;
  const float* transmittance = nullptr;
};

Behind behind_zone(const SurfaceModel& surfaces, const ZoneMesh& mesh, ZoneId zone) {
  const TriangleId triangle = mesh.zone_triangle(zone);
  if (!surfaces.any_specular() || !surfaces.is_specular(triangle, mesh.zone_is_front(zone))) return {};
  const SpecularSurface& surface = surfaces.specular(triangle);
  if (!surface.diffuses()) return {};
  return {opposite_zones(mesh, zone), surface.diffuse_transmittance().data()};
}

/// By channel. Partial sums of fixed chunks are added in order: the same bits on any number of threads.
std::vector<ChannelError> channel_errors(ErrorOf what, const SurfaceModel& surfaces, const ZoneMesh& mesh,
                                         const ZoneSums& sums, bool with_groups) {
  const std::size_t channels = sums.channels.count();
  const std::size_t zones = mesh.zone_count();
  const std::size_t chunks = (zones + kChunk - 1) / kChunk;
  const auto w = static_cast<double>(sums.weight());
  std::vector<ChannelError> parts(chunks * channels);
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    std::vector<SentOn> sent;
    for (std::size_t z = chunk * kChunk; z < std::min(zones, (chunk + 1) * kChunk); ++z) {
      const double area = mesh.zone_area(ZoneId(z));
      const Behind behind =
          what == ErrorOf::kScatteredLight ? behind_zone(surfaces, mesh, ZoneId(z)) : Behind{};
      const double* reflectance =
          surfaces.reflectance(ZoneId(z), mesh.zone_triangle(ZoneId(z)), mesh.zone_is_front(ZoneId(z)));
      sums.channels.for_each([&](std::size_t c, std::size_t band) {
        sent.clear();
        double radiosity = 0;
        double variance = 0;  // of it; what comes from either side is taken as independent
        const auto add = [&](std::size_t zone, double share) {
          const std::size_t i = zone * channels + c;
          const double mean = sums.total(i) / w;
          if (mean == 0) return;
          sent.push_back({i, mean, share});
          radiosity += share * mean;
          variance += share * share * variance_of_mean(sums, i);
        };
        add(z, what == ErrorOf::kScatteredLight ? reflectance[band] : 1);
        for (const ZoneShare& other : behind.zones)
          add(other.zone.index(), other.share * static_cast<double>(behind.transmittance[band]));
        if (radiosity == 0) return;
        ChannelError& part = parts[chunk * channels + c];
        part.noise += area * variance;
        part.signal += area * radiosity * radiosity;
        if (with_groups) add_products(sums, sent, area, part);
      });
    }
  });
  std::vector<ChannelError> result(channels);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    ChannelError& sum = result[p % channels];
    sum.noise += parts[p].noise;
    sum.signal += parts[p].signal;
    std::transform(sum.products.begin(), sum.products.end(), parts[p].products.begin(), sum.products.begin(),
                   std::plus<>());
  }
  const std::size_t groups = groups_with_batches(sums);
  for (ChannelError& sum : result)
    for (std::size_t g = 0; g < groups; ++g)
      for (std::size_t h = 0; h < g; ++h) sum.products[g * groups + h] = sum.products[h * groups + g];
  return result;
}

/// Of what surfaces reflect and let through diffusely, or where none do, as in rooms that are black to be
/// measured in, of irradiance.
std::vector<ChannelError> channel_errors(const SurfaceModel& surfaces, const ZoneMesh& mesh,
                                         const ZoneSums& sums, bool with_groups) {
  std::vector<ChannelError> errors =
      channel_errors(ErrorOf::kScatteredLight, surfaces, mesh, sums, with_groups);
  const bool is_black =
      std::all_of(errors.begin(), errors.end(), [](const ChannelError& sum) { return sum.signal == 0; });
  return is_black ? channel_errors(ErrorOf::kIrradiance, surfaces, mesh, sums, with_groups) : errors;
}

double relative_rms(const ChannelError& sum) {
  return sum.signal > 0 ? std::sqrt(sum.noise / sum.signal) : 0.0;
}

/// 95th percentile of s/E over lit zones, and the zones that nothing reached.
void find_percentile(const ZoneSums& sums, ZoneError& result) {
  const std::size_t channels = sums.channels.count();
  const std::size_t values = sums.direct.size();
  const auto total = [&](std::size_t i) { return sums.total(i); };
  for (std::size_t first = 0; first < values; first += channels) {
    bool reached = false;
    for (std::size_t i = first; i < first + channels; ++i) reached = reached || total(i) > 0;
    if (!reached) ++result.unreached;
  }
  if (sums.batches < 2) return;
  const auto w = static_cast<double>(sums.weight());
  std::vector<double> percentiles(channels, 0.0);
  tbb::parallel_for(std::size_t{0}, channels, [&](std::size_t c) {
    std::vector<float> lit;
    for (std::size_t i = c; i < values; i += channels)
      if (total(i) > 0)
        lit.push_back(static_cast<float>(std::sqrt(variance_of_mean(sums, i)) * w / total(i)));
    if (lit.empty()) return;
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), at, lit.end());
    percentiles[c] = static_cast<double>(*at);
  });
  for (const double p : percentiles) result.percentile_95 = std::max(result.percentile_95, p);
}

}  // namespace

double zone_rms_error(const SurfaceModel& surfaces, const ZoneMesh& mesh, const ZoneSums& sums) {
  if (sums.batches < 2) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const ChannelError& sum : channel_errors(surfaces, mesh, sums, false))
    worst = std::max(worst, relative_rms(sum));
  return worst;
}

ZoneError zone_error(const SurfaceModel& surfaces, const ZoneMesh& mesh, const ZoneSums& sums) {
  ZoneError result;
  find_percentile(sums, result);
  if (sums.batches < 2) {
    result.rms = result.bound = result.percentile_95 = std::numeric_limits<double>::infinity();
    return result;
  }
  const std::size_t groups = groups_with_batches(sums);
  for (const ChannelError& sum : channel_errors(surfaces, mesh, sums, true)) {
    const double rms = relative_rms(sum);
    result.rms = std::max(result.rms, rms);
    const double quotient = largest_error_quotient(std::span(sum.products).first(groups * groups), groups);
    result.bound = std::max(result.bound, rms * std::sqrt(quotient));
  }
  return result;
}

}  // namespace reemit
