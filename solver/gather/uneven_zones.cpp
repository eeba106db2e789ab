#include "solver/gather/uneven_zones.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include <tbb/parallel_for.h>

#include "solver/gather/light_spread.h"
#include "solver/gather/point_sampler.h"
#include "solver/gather/replicate_gather.h"
#include "solver/gather/seen_light.h"
#include "solver/reflect/lambert.h"

namespace reemit {
namespace {

/// Standard deviation of reflected radiance inside a zone, over the mean of the room, from which on a zone is
/// uneven. A quarter of that changes what is left of the bias in a room with lamps close to the ceiling by
/// less than a tenth, and costs a furnished office a fifth of its time.
constexpr double kUneven = 1;
/// Radiance over the mean of the room from which on any error of the zone matters.
constexpr double kBright = 16;
/// Share of the light that gather rays read, by which zones whose seen part is brighter than their mean may
/// mislead them in all, and zones whose seen part is darker: the zones with the largest differences are
/// uneven until the others stay below it. About the noise of the look in a room without such zones.
constexpr double kMisread = 0.002;
/// Share of the area that gather rays are continued from at most: bounds what that costs.
constexpr double kMostArea = 0.2;
/// Points per zone and shadow rays per point of each of two halves: of zones that follow each other, which
/// mostly lie beside each other, as if they were one; of each where these differ; and of those that this
/// leaves in doubt.
struct Look {
  int points;
  int rays;
};
constexpr Look kLookAtGroup{2, 1};
constexpr Look kFirstLook{4, 1};
constexpr Look kSecondLook{16, 2};
/// Share of the limits from which on the zones of a group are looked at one by one, and from which on a zone
/// gets a second look.
constexpr double kDoubtInGroup = 0.25;
constexpr double kDoubt = 0.5;
constexpr std::size_t kHalves = 2;

/// Direct light inside a zone, as reflected radiance over the room's mean, of the band that matters most.
struct Spread {
  double mean = 0;
  double variance = 0;  // over the zone; an estimate, may be below 0
};

/// By zone and band, the mean over all parts.
std::vector<float> reflected_radiance(const RadianceField& field) {
  const std::size_t bands = field.band_count();
  const std::size_t zones = field.room().mesh().zone_count();
  std::vector<float> reflected(zones * bands, 0.0F);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, zones, 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z)
      for (std::size_t b = 0; b < bands; ++b) reflected[z * bands + b] = field.mean_reflected(ZoneId(z), b);
  });
  return reflected;
}

/// Per band, the mean reflected radiance over all area.
std::vector<double> mean_radiance(const ZoneMesh& mesh, const std::vector<float>& reflected,
                                  std::size_t bands) {
  std::vector<double> mean(bands, 0.0);
  double area = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const double zone_area = mesh.zone_area(ZoneId(z));
    area += zone_area;
    for (std::size_t b = 0; b < bands; ++b)
      mean[b] += zone_area * static_cast<double>(reflected[z * bands + b]);
  }
  for (double& m : mean) m /= area;
  return mean;
}

/// Looks at zones; the room's mean is the measure.
class Looker {
 public:
  /// `mean`: reflected radiance of the room, by band.
  Looker(const RadianceField& field, const DirectLight& direct, std::span<const double> mean,
         std::uint64_t seed)
      : room_(field.room()), field_(field), direct_(direct), seed_(seed), mean_(mean) {}

  /// Over `count` zones from `first` on, each with so many points.
  Spread look(std::size_t first, std::size_t count, const Look& effort) const {
    const std::size_t bands = field_.band_count();
    const std::size_t points = count * static_cast<std::size_t>(effort.points);
    std::vector<float> weight(bands);
    std::vector<float> found(kHalves * points * bands, 0.0F);  // by half, point and band; over the mean
    float* next = found.data();
    for (std::size_t z = first; z < first + count; ++z) {
      const ZoneId zone(z);
      weigh(zone, effort.rays, weight);
      const std::array<PointSampler, kHalves> samplers{sampler(zone, 0, effort), sampler(zone, 1, effort)};
      for (int i = 0; i < effort.points; ++i, next += bands) {
        const SurfacePoint x = point_in_zone(room_, zone, samplers[0].place(i));
        for (std::size_t half = 0; half < kHalves; ++half) {
          const auto shadow = [&](int ray) { return samplers[half].light(i, ray, effort.rays); };
          direct_.add_samples(x, effort.rays, shadow, weight.data(), next + half * points * bands);
        }
      }
    }
    Spread worst;
    for (std::size_t b = 0; b < bands; ++b) {
      const Spread spread = spread_of(&found[b], points, bands);
      worst.mean = std::max(worst.mean, spread.mean);
      worst.variance = std::max(worst.variance, spread.variance);
    }
    return worst;
  }

 private:
  PointSampler sampler(ZoneId zone, int number, const Look& effort) const {
    return {seed_, RngPurpose::kUnevenZone, zone.index(), number,
            std::countr_zero(static_cast<unsigned>(effort.points))};
  }

  /// What makes reflected radiance over the room's mean out of the irradiance of one of so many rays; 0 in
  /// bands without light.
  void weigh(ZoneId zone, int rays, std::vector<float>& weight) const {
    const float* reflectance = room_.zone_reflectance(zone);
    for (std::size_t b = 0; b < weight.size(); ++b)
      weight[b] =
          mean_[b] > 0 ? static_cast<float>(lambert_brdf_per_sr(reflectance[b]) / (mean_[b] * rays)) : 0.0F;
  }

  static Spread spread_of(const float* values, std::size_t points, std::size_t bands) {
    LightSpread light;
    for (std::size_t i = 0; i < points; ++i)
      light.add(static_cast<double>(values[i * bands]), static_cast<double>(values[(points + i) * bands]));
    return {light.mean(), light.variance()};
  }

  const Room& room_;
  const RadianceField& field_;
  const DirectLight& direct_;
  std::uint64_t seed_;
  std::span<const double> mean_;
};

/// Over the limits: from 1 on a zone is uneven.
double unevenness(const Spread& spread) {
  return std::max(std::sqrt(std::max(spread.variance, 0.0)) / kUneven, spread.mean / kBright);
}

/// What gather rays read in all of the zones, and by how much of it they are misled: areas times radiance
/// over the room's mean.
class Misreading {
 public:
  Misreading(const ZoneMesh& mesh, const std::vector<float>& reflected, const std::vector<double>& mean,
             const std::vector<SeenLight::Zone>& seen)
      : mesh_(mesh), seen_(seen) {
    const std::size_t bands = mean.size();
    for (std::size_t z = 0; z < seen.size(); ++z)
      for (std::size_t b = 0; b < bands; ++b)
        if (mean[b] > 0)
          read_ += weight(z) * static_cast<double>(reflected[z * bands + b]) /
                   (mean[b] * static_cast<double>(bands));
  }

  /// Raises harm[z] to the difference in those of the zones of one sign that have to be continued, so that
  /// what is left of their sign stays within the limit; zones with harm are continued anyway.
  void add_harm(double sign, std::vector<double>& harm) const {
    std::vector<std::size_t> order;
    double left = 0;
    for (std::size_t z = 0; z < seen_.size(); ++z) {
      if (harm[z] > 0 || !(sign * seen_[z].misread > 0)) continue;
      order.push_back(z);
      left += weight(z) * sign * seen_[z].misread;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return sign * seen_[a].misread > sign * seen_[b].misread;
    });
    for (const std::size_t z : order) {
      if (left <= kMisread * read_) return;
      harm[z] = sign * seen_[z].misread;
      left -= weight(z) * sign * seen_[z].misread;
    }
  }

 private:
  double weight(std::size_t z) const { return mesh_.zone_area(ZoneId(z)) * seen_[z].open; }

  const ZoneMesh& mesh_;
  const std::vector<SeenLight::Zone>& seen_;
  double read_ = 0;
};

}  // namespace

std::vector<std::uint8_t> uneven_zones(const RadianceField& field, const DirectLight& direct,
                                       std::uint64_t seed, const StopToken* stop) {
  const ZoneMesh& mesh = field.room().mesh();
  std::vector<std::uint8_t> uneven(mesh.zone_count(), 0);
  const auto is_to_stop = [stop] { return stop != nullptr && stop->requested(); };
  if (direct.empty() || is_to_stop()) return uneven;
  const std::vector<float> reflected = reflected_radiance(field);
  const std::vector<double> mean = mean_radiance(mesh, reflected, field.band_count());
  const Looker looker(field, direct, mean, seed);
  const SeenLight seen_light(field, direct, reflected, mean, seed);
  std::vector<SeenLight::Zone> seen(mesh.zone_count());
  std::vector<double> harm(mesh.zone_count(), 0.0);
  constexpr std::size_t kGroup = SeenLight::kTogether;
  tbb::parallel_for(std::size_t{0}, (mesh.zone_count() + kGroup - 1) / kGroup, [&](std::size_t group) {
    if (is_to_stop()) return;
    const std::size_t first = kGroup * group;
    const std::size_t count = std::min(kGroup, mesh.zone_count() - first);
    seen_light.look(ZoneId(first), std::span(seen).subspan(first, count));
    if (unevenness(looker.look(first, count, kLookAtGroup)) <= kDoubtInGroup) return;
    for (std::size_t z = first; z < first + count; ++z) {
      if (unevenness(looker.look(z, 1, kFirstLook)) <= kDoubt) continue;
      const double looked_at = unevenness(looker.look(z, 1, kSecondLook));
      if (looked_at > 1) harm[z] = looked_at;
    }
  });
  if (is_to_stop()) return uneven;
  const Misreading misreading(mesh, reflected, mean, seen);
  for (const double sign : {1.0, -1.0}) misreading.add_harm(sign, harm);

  std::vector<std::size_t> order;
  double area_left = 0;
  for (std::size_t z = 0; z < harm.size(); ++z) {
    area_left += kMostArea * mesh.zone_area(ZoneId(z));
    if (harm[z] > 0) order.push_back(z);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return harm[a] > harm[b]; });
  for (const std::size_t z : order) {
    area_left -= mesh.zone_area(ZoneId(z));
    if (area_left < 0) break;
    uneven[z] = 1;
  }
  return uneven;
}

}  // namespace reemit
