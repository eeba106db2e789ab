#include "solver/solution/solution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "solver/solution/opposite_zones.h"

namespace reemit {
namespace {

Estimate batch_mean(const ZoneSums& sums, double sum, double cross, double squares) {
  if (sums.batches == 0) return {};
  const double mean = sum / static_cast<double>(sums.weight());
  if (sums.batches == 1) return {mean, std::numeric_limits<double>::infinity()};
  return {mean, std::sqrt(sums.squared_error(sum, cross, squares))};
}

template <class Values, class Sums>
std::vector<Values*> columns_of(Sums& s) {
  std::vector<Values*> columns{&s.direct,         &s.indirect,         &s.direct_cross, &s.indirect_cross,
                               &s.direct_squared, &s.indirect_squared, &s.total_squared};
  if (s.has_caustics()) columns.insert(columns.end(), {&s.caustic, &s.caustic_cross, &s.caustic_squared});
  return columns;
}

Eigen::Index band_index(std::size_t band) {
  return static_cast<Eigen::Index>(band);
}

}  // namespace

std::vector<std::vector<double>*> ZoneSums::columns() {
  return columns_of<std::vector<double>>(*this);
}

std::vector<const std::vector<double>*> ZoneSums::columns() const {
  return columns_of<const std::vector<double>>(*this);
}

void ZoneSums::clear(std::size_t zones, Channels of_zones, bool caustics) {
  channels = of_zones;
  const std::size_t values = zones * channels.count();
  batches = 0;
  group_weight.fill(0);
  weight_squared = 0;
  caustic.resize(caustics ? values : 0);
  caustic_cross = caustic_squared = caustic;
  for (std::vector<double>* sum : columns()) sum->assign(values, 0.0);
  group_total.assign(kGroups * values, 0.0F);
}

std::size_t ZoneSums::count_batch(std::int64_t w) {
  const std::size_t group = static_cast<std::size_t>(batches) % kGroups;
  ++batches;
  group_weight[group] += w;
  weight_squared += static_cast<double>(w) * static_cast<double>(w);
  return group;
}

std::int64_t ZoneSums::weight() const {
  return std::accumulate(group_weight.begin(), group_weight.end(), std::int64_t{0});
}

double ZoneSums::degrees_of_freedom() const {
  const auto w = static_cast<double>(weight());
  return batches == 0 ? 0.0 : w * w / weight_squared - 1;
}

double ZoneSums::squared_error(double sum, double cross, double squares) const {
  const auto w = static_cast<double>(weight());
  const double mean = sum / w;
  // Rounding can push the spread below 0 when all batches agree.
  return std::max(0.0, squares - 2 * mean * cross + mean * mean * weight_squared) / (w * w - weight_squared);
}

void GatheredZones::keep(const ZoneSums& from, std::vector<ZoneId> of_zones) {
  const std::size_t channels = from.channels.count();
  const auto columns = from.columns();
  const std::size_t values = from.direct.size();
  std::vector<double> kept;
  kept.reserve(of_zones.size() * channels * columns.size());
  for (const ZoneId z : of_zones)
    for (std::size_t i = z.index() * channels; i < (z.index() + 1) * channels; ++i)
      for (const std::vector<double>* column : columns) kept.push_back((*column)[i]);
  std::vector<float> kept_total;
  kept_total.reserve(ZoneSums::kGroups * of_zones.size() * channels);
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
    for (const ZoneId z : of_zones)
      for (std::size_t c = 0; c < channels; ++c)
        kept_total.push_back(from.group_total[g * values + z.index() * channels + c]);
  zones = std::move(of_zones);
  sums = std::move(kept);
  group_total = std::move(kept_total);
}

void GatheredZones::restore(ZoneSums& to) const {
  const std::size_t channels = to.channels.count();
  auto next = sums.begin();
  for (const ZoneId z : zones)
    for (std::size_t i = z.index() * channels; i < (z.index() + 1) * channels; ++i)
      for (std::vector<double>* column : to.columns()) (*column)[i] = *next++;
  const std::size_t values = to.direct.size();
  auto next_total = group_total.begin();
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
    for (const ZoneId z : zones)
      for (std::size_t c = 0; c < channels; ++c)
        to.group_total[g * values + z.index() * channels + c] = *next_total++;
}

std::string to_string(StopReason reason) {
  switch (reason) {
    case StopReason::kUnderWay:
      return "not finished";
    case StopReason::kErrorTarget:
      return "error target reached";
    case StopReason::kTimeLimit:
      return "time limit reached";
    case StopReason::kPacketCount:
      return "packet count reached";
    case StopReason::kInterrupted:
      return "interrupted";
    case StopReason::kBatchLimit:
      return "batch limit reached";
    case StopReason::kBounceLimit:
      return "bounce limit reached";
    case StopReason::kNoLuminaire:
      return "no luminaire in the room";
    case StopReason::kSystemSolved:
      return "linear system solved";
  }
  return "unknown";
}

template <class Part>
Estimate Solution::over_groups(ZoneId z, std::size_t band, const Part& part) const {
  Estimate all;
  for (std::size_t group = 0; group < sums.channels.groups(); ++group) {
    const Estimate one = part(z.index() * sums.channels.count() + sums.channels.channel(group, band));
    all.mean += one.mean;
    all.stderr_of_mean += one.stderr_of_mean;
  }
  return all;
}

Estimate Solution::direct_irradiance(ZoneId z, std::size_t band) const {
  return over_groups(z, band, [&](std::size_t i) {
    return batch_mean(sums, sums.direct[i], sums.direct_cross[i], sums.direct_squared[i]);
  });
}

Estimate Solution::indirect_irradiance(ZoneId z, std::size_t band) const {
  return over_groups(z, band, [&](std::size_t i) {
    return batch_mean(sums, sums.indirect[i], sums.indirect_cross[i], sums.indirect_squared[i]);
  });
}

Estimate Solution::caustic_irradiance(ZoneId z, std::size_t band) const {
  if (!sums.has_caustics()) return {};
  return over_groups(z, band, [&](std::size_t i) {
    return batch_mean(sums, sums.caustic[i], sums.caustic_cross[i], sums.caustic_squared[i]);
  });
}

Estimate Solution::irradiance(ZoneId z, std::size_t band) const {
  return over_groups(z, band, [&](std::size_t i) {
    return batch_mean(sums, sums.total(i), sums.total_cross(i), sums.total_squared[i]);
  });
}

double Solution::emitted_radiosity(ZoneId z, std::size_t band) const {
  if (!zone_exitances.empty()) return zone_exitances[z.index() * bands.count() + band];
  const Material& material = zone_material(z);
  if (!material.emits_both_sides && !mesh.zone_shows_front(z)) return 0;
  return material.exitance()[band_index(band)];
}

Estimate Solution::transmitted(ZoneId z, std::size_t band, Irradiance of) const {
  const double through = zone_material(z).diffuse_transmittance(band);
  if (!(through > 0)) return {};
  Estimate sum;
  double variance = 0;
  for (const ZoneShare& behind : opposite_zones(mesh, z)) {
    const Estimate there = (this->*of)(behind.zone, band);
    sum.mean += through * behind.share * there.mean;
    variance += std::pow(through * behind.share * there.stderr_of_mean, 2);
  }
  return {sum.mean, std::sqrt(variance)};
}

Estimate Solution::scattered(ZoneId z, std::size_t band, Irradiance of) const {
  const double reflectance = zone_reflectance(z, band);
  const Estimate e = (this->*of)(z, band);
  const Estimate through = transmitted(z, band, of);
  // A black zone reflects nothing however little is known about its irradiance.
  const double error = reflectance > 0 ? reflectance * e.stderr_of_mean : 0;
  return {reflectance * e.mean + through.mean,
          through.stderr_of_mean > 0 ? std::hypot(error, through.stderr_of_mean) : error};
}

Estimate Solution::radiosity(ZoneId z, std::size_t band) const {
  const Estimate e = scattered(z, band, &Solution::irradiance);
  return {emitted_radiosity(z, band) + e.mean, e.stderr_of_mean};
}

std::vector<std::string> room_files(const Solution& solution) {
  std::vector<std::string> files{solution.room_path};
  files.insert(files.end(), solution.more_room_paths.begin(), solution.more_room_paths.end());
  return files;
}

void keep_surfaces(const Scene& scene, Solution& solution) {
  solution.surface_names.clear();
  solution.surface_materials.clear();
  for (const Surface& surface : scene.surfaces) {
    solution.surface_names.push_back(surface.name);
    solution.surface_materials.push_back(surface.material);
  }
  solution.materials = scene.materials;
  for (Material& material : solution.materials) {
    NonDiffusePart kept;
    if (material.non_diffuse.transmits_diffusely())
      kept.diffuse_transmittance = material.non_diffuse.diffuse_transmittance;
    material.non_diffuse = std::move(kept);
    material.textures = {};  // zones have their means
  }
}

}  // namespace reemit
