#include "solver/solution/solution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace reemit {
namespace {

Estimate batch_mean(double sum, double sum_of_squares, std::int64_t batches) {
  if (batches == 0) return {};
  const auto n = static_cast<double>(batches);
  if (batches == 1) return {sum, std::numeric_limits<double>::infinity()};
  // Rounding can push the difference below 0 when all batches agree.
  const double spread = std::max(0.0, sum_of_squares - sum * sum / n);
  return {sum / n, std::sqrt(spread / (n * (n - 1)))};
}

Eigen::Index to_index(std::size_t band) {
  return static_cast<Eigen::Index>(band);
}

}  // namespace

void ZoneSums::clear(std::size_t values) {
  batches = 0;
  for (auto* sum : {&direct, &direct_squared, &indirect, &indirect_squared, &total_squared})
    sum->assign(values, 0.0);
  group_total.assign(kGroups * values, 0.0);
}

std::string to_string(StopReason reason) {
  switch (reason) {
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
    case StopReason::kNoLuminaire:
      return "no luminaire in the room";
    case StopReason::kSystemSolved:
      return "linear system solved";
  }
  return "unknown";
}

Estimate Solution::direct_irradiance(ZoneId z, std::size_t band) const {
  const std::size_t i = z.index() * bands.count() + band;
  return batch_mean(sums.direct[i], sums.direct_squared[i], sums.batches);
}

Estimate Solution::indirect_irradiance(ZoneId z, std::size_t band) const {
  const std::size_t i = z.index() * bands.count() + band;
  return batch_mean(sums.indirect[i], sums.indirect_squared[i], sums.batches);
}

Estimate Solution::irradiance(ZoneId z, std::size_t band) const {
  const std::size_t i = z.index() * bands.count() + band;
  return batch_mean(sums.direct[i] + sums.indirect[i], sums.total_squared[i], sums.batches);
}

double Solution::emitted_radiosity(ZoneId z, std::size_t band) const {
  const Material& material = zone_material(z);
  if (!material.emits_both_sides && !mesh.zone_is_front(z)) return 0;
  return material.exitance()[to_index(band)];
}

Estimate Solution::radiosity(ZoneId z, std::size_t band) const {
  const double reflectance = zone_material(z).reflectance[to_index(band)];
  const Estimate e = irradiance(z, band);
  // A black zone reflects nothing however little is known about its irradiance.
  const double error = reflectance > 0 ? reflectance * e.stderr_of_mean : 0;
  return {emitted_radiosity(z, band) + reflectance * e.mean, error};
}

void keep_surfaces(const Scene& scene, Solution& solution) {
  solution.surface_names.clear();
  solution.surface_materials.clear();
  for (const Surface& surface : scene.surfaces) {
    solution.surface_names.push_back(surface.name);
    solution.surface_materials.push_back(surface.material);
  }
  solution.materials = scene.materials;
  for (Material& material : solution.materials) material.non_diffuse = {};
}

}  // namespace reemit
