#include "solver/gather/radiance_field.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mesh/zones/zone_cells.h"
#include "scenes/model/error.h"
#include "solver/reflect/lambert.h"
#include "solver/solution/opposite_zones.h"
#include "solver/solution/room_of_solution.h"

namespace reemit {
namespace {

/// Of all light groups and batches.
float mean_irradiance(const ZoneSums& sums, const std::vector<double>& of_part, std::size_t zone,
                      std::size_t band) {
  const double sum = sums.channels.over_groups(
      band, [&](std::size_t c) { return of_part[zone * sums.channels.count() + c]; });
  return static_cast<float>(sum / static_cast<double>(sums.weight()));
}

}  // namespace

RadianceField::RadianceField(const Room& room, const Solution& solution, std::size_t parts)
    : room_(&room), bands_(room.band_count()), parts_(parts), zero_(bands_, 0.0F) {
  check_has_zones_of(solution, room.scene(), room.mesh());
  read_zones(solution);
}

float RadianceField::mean_reflected(ZoneId zone, std::size_t band) const {
  double sum = 0;
  for (std::size_t part = 0; part < parts_; ++part) sum += static_cast<double>(reflected(zone, part)[band]);
  return static_cast<float>(sum / static_cast<double>(parts_));
}

bool RadianceField::has_light_that_rays_miss() const {
  constexpr double kMostMissed = 0.005;
  const Scene& scene = room_->scene();
  const bool has_small_lights = !scene.lights.empty() || (scene.sky && scene.sky->sun_shines());
  return has_small_lights && caustic_share() >= kMostMissed;
}

double RadianceField::caustic_share() const {
  double worst = 0;
  for (std::size_t b = 0; b < bands_; ++b) {
    double caustic = 0;
    double all = 0;
    for (std::size_t i = 0; i < room_->mesh().zone_count(); ++i) {
      const ZoneId zone(i);
      const double area = room_->mesh().zone_area(zone);
      caustic += area * static_cast<double>(reflected_caustic(zone)[b]);
      all += area * static_cast<double>(mean_reflected(zone, b));
    }
    if (all > 0) worst = std::max(worst, caustic / all);
  }
  return worst;
}

float RadianceField::zone_size(ZoneId z) const {
  const ZoneMesh& mesh = room_->mesh();
  const double area = mesh.is_group(z) ? mesh.zone_area(z) : cell_area(mesh, mesh.zone_cell(z));
  const double metres = std::sqrt(2 * area);
  return static_cast<float>(metres / room_->rays().metres_per_unit());
}

void RadianceField::read_zones(const Solution& solution) {
  const ZoneSums& sums = solution.sums;
  const std::size_t zones = solution.mesh.zone_count();
  values_ = zones * bands_;
  const auto most_parts = static_cast<std::size_t>(std::max<std::int64_t>(1, sums.batches));
  parts_ = std::min({std::bit_floor(parts_), std::bit_floor(most_parts), ZoneSums::kGroups});
  reflected_.assign(parts_ * values_, 0.0F);
  reflected_direct_.assign(values_, 0.0F);
  reflected_caustic_.assign(sums.has_caustics() ? values_ : 0, 0.0F);
  if (sums.batches <= 0) return;
  const std::size_t sum_count = zones * sums.channels.count();
  if (sums.direct.size() != sum_count || sums.indirect.size() != sum_count ||
      sums.group_total.size() != ZoneSums::kGroups * sum_count)
    throw InputError(solution.room_path, "the solution does not hold one value per zone and band",
                     "Solve the room again: the file is damaged.");
  std::vector<double> part_weight(parts_, 0.0);
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
    part_weight[g % parts_] += static_cast<double>(sums.group_weight[g]);
  const auto read = [&](std::size_t z) {
    const ZoneMesh& mesh = solution.mesh;
    const double* rho = room_->surfaces().reflectance(ZoneId(z), mesh.zone_triangle(ZoneId(z)),
                                                      mesh.zone_is_front(ZoneId(z)));
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t k = z * bands_ + b;
      const auto reflectance = static_cast<float>(rho[b]);
      reflected_direct_[k] =
          lambert_reflected_radiance(reflectance, mean_irradiance(sums, sums.direct, z, b));
      if (!reflected_caustic_.empty())
        reflected_caustic_[k] =
            lambert_reflected_radiance(reflectance, mean_irradiance(sums, sums.caustic, z, b));
      for (std::size_t p = 0; p < parts_; ++p)
        reflected_[p * values_ + k] =
            lambert_reflected_radiance(reflectance, irradiance(sums, p, part_weight[p], z, b));
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, zones, 4096), [&](const auto& range) {
    for (std::size_t z = range.begin(); z != range.end(); ++z) read(z);
  });
  add_transmitted(solution, part_weight);
}

float RadianceField::irradiance(const ZoneSums& sums, std::size_t part, double weight, std::size_t zone,
                                std::size_t band) const {
  const std::size_t channels = sums.channels.count();
  const std::size_t values = sums.direct.size();
  const double total = sums.channels.over_groups(band, [&](std::size_t c) {
    const std::size_t k = zone * channels + c;
    if (parts_ == 1) return sums.total(k);
    double of_part = 0;
    for (std::size_t g = part; g < ZoneSums::kGroups; g += parts_)
      of_part += static_cast<double>(sums.group_total[g * values + k]);
    return of_part;
  });
  return static_cast<float>(total / weight);
}

void RadianceField::add_transmitted(const Solution& solution, const std::vector<double>& part_weight) {
  const Scene& scene = room_->scene();
  const ZoneSums& sums = solution.sums;
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) {
    const SurfaceId surface = solution.mesh.zone_surface(ZoneId(z));
    const Material& material = scene.material_of(scene.surfaces[surface.index()]);
    if (!material.non_diffuse.transmits_diffusely()) continue;
    for (const ZoneShare& behind : opposite_zones(solution.mesh, ZoneId(z)))
      for (std::size_t b = 0; b < bands_; ++b) {
        const auto through = static_cast<float>(behind.share * material.diffuse_transmittance(b));
        const std::size_t to = z * bands_ + b;
        const std::size_t from = behind.zone.index();
        reflected_direct_[to] +=
            lambert_reflected_radiance(through, mean_irradiance(sums, sums.direct, from, b));
        if (!reflected_caustic_.empty())
          reflected_caustic_[to] +=
              lambert_reflected_radiance(through, mean_irradiance(sums, sums.caustic, from, b));
        for (std::size_t p = 0; p < parts_; ++p)
          reflected_[p * values_ + to] +=
              lambert_reflected_radiance(through, irradiance(sums, p, part_weight[p], from, b));
      }
  }
}

}  // namespace reemit
