#include "solver/solution/mean_light.h"

#include <array>
#include <cmath>
#include <limits>

#include "mesh/zones/surface_side.h"

namespace reemit {
namespace {

/// Means over a set of zones of one material, per band.
struct GroupedMean {
  explicit GroupedMean(std::size_t bands)
      : emitted(Spectrum::Zero(static_cast<Eigen::Index>(bands))), scatters(emitted) {
    groups.fill({emitted, emitted, emitted});
    all = groups[0];
  }

  bool dark() const { return (all.irradiance == 0).all() && (emitted == 0).all(); }

  /// Adds the zones of another set.
  void merge(const GroupedMean& other) {
    const double both = area + other.area;
    if (!(both > 0)) return;
    const auto weigh = [&](Spectrum& own, const Spectrum& added) {
      own = (area * own + other.area * added) / both;
    };
    weigh(emitted, other.emitted);
    weigh(scatters, other.scatters);
    const auto weigh_light = [&](Light& own, const Light& added) {
      weigh(own.irradiance, added.irradiance);
      weigh(own.scattered, added.scattered);
    };
    weigh_light(all, other.all);
    for (std::size_t g = 0; g < ZoneSums::kGroups; ++g) weigh_light(groups[g], other.groups[g]);
    area = both;
    met_by_packets = met_by_packets || other.met_by_packets;
  }

  struct Light {
    Spectrum irradiance;  // [W/m2]
    Spectrum scattered;   // reflected, and let through from the other side [W/m2]
    Spectrum reflected;   // sum over zones of area times what textures make them reflect more than their mean
  };
  double area = 0;                              // [m2]
  bool met_by_packets = false;                  // by some zone; else all of it was gathered
  Spectrum emitted;                             // by the zones themselves [W/m2]
  Spectrum scatters;                            // 0 where no light is reflected or let through
  Light all;                                    // of all batches
  std::array<Light, ZoneSums::kGroups> groups;  // of each group of batches
};

/// Fills in what the sides of a surface scatter of their own irradiance and that of the other.
void scatter(const Material& material, GroupedMean& side, const GroupedMean& other, bool front) {
  const Spectrum& rho = material.reflectance_of(front);
  const Spectrum& tau = material.non_diffuse.diffuse_transmittance;
  const bool lets_through = tau.size() > 0 && other.area > 0;
  const auto fill = [&](GroupedMean::Light& light, const GroupedMean::Light& behind) {
    light.scattered = rho * light.irradiance;
    if (lets_through) light.scattered += tau * behind.irradiance;
  };
  fill(side.all, other.all);
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g) fill(side.groups[g], other.groups[g]);
  side.scatters = rho;
  if (lets_through) side.scatters += tau;
}

/// Sides by index surface * 2 + (0 front, 1 back); of area 0 where a side has no zones.
class Sides {
 public:
  explicit Sides(const Solution& solution)
      : solution_(solution),
        mesh_(solution.mesh),
        sums_(solution.sums),
        bands_(solution.bands.count()),
        sides_(2 * solution.surface_names.size(), GroupedMean(bands_)) {}

  std::vector<GroupedMean> gather() {
    add_emission();
    mark_what_packets_meet();
    add_irradiance();
    for (std::size_t s = 0; s < sides_.size(); ++s)
      scatter(solution_.materials[solution_.surface_materials[s / 2].index()], sides_[s], sides_[s ^ 1U],
              s % 2 == 0);
    if (reflectance_varies()) add_what_zones_reflect_beyond_the_mean();
    return std::move(sides_);
  }

 private:
  bool reflectance_varies() const { return !solution_.zone_reflectances.empty(); }

  GroupedMean& side_of(ZoneId z) { return sides_[surface_side(mesh_, mesh_.zone_side(z))]; }

  /// Of value zone * channels + channel in one group of batches.
  double of_group(std::size_t group, std::size_t i) const {
    return static_cast<double>(sums_.group_total[group * sums_.direct.size() + i]);
  }

  template <class Value, class Into>
  void add_up(const Value& value_of, const Into& into) {
    for (std::size_t z = 0; z < mesh_.zone_count(); ++z) {
      Spectrum& sum = into(side_of(ZoneId(z)));
      const double area = mesh_.zone_area(ZoneId(z));
      for (std::size_t b = 0; b < bands_; ++b)
        sum[static_cast<Eigen::Index>(b)] += area * sums_.channels.over_groups(b, [&](std::size_t c) {
          return value_of(z * sums_.channels.count() + c);
        });
    }
  }

  void add_emission() {
    for (std::size_t z = 0; z < mesh_.zone_count(); ++z) {
      GroupedMean& side = side_of(ZoneId(z));
      side.area += mesh_.zone_area(ZoneId(z));
      for (std::size_t b = 0; b < bands_; ++b) {
        double& emitted = side.emitted[static_cast<Eigen::Index>(b)];
        const double here = solution_.emitted_radiosity(ZoneId(z), b);
        emitted =
            reflectance_varies() ? emitted + mesh_.zone_area(ZoneId(z)) / side.area * (here - emitted) : here;
      }
    }
  }

  void mark_what_packets_meet() {
    std::vector<bool> gathered(mesh_.zone_count());
    for (const ZoneId z : solution_.gathered.zones) gathered[z.index()] = true;
    for (std::size_t z = 0; z < mesh_.zone_count(); ++z)
      if (!gathered[z] && !mesh_.is_sealed(ZoneId(z))) side_of(ZoneId(z)).met_by_packets = true;
  }

  void add_irradiance() {
    add_up([&](std::size_t i) { return sums_.total(i); },
           [](GroupedMean& side) -> Spectrum& { return side.all.irradiance; });
    for (std::size_t g = 0; g < ZoneSums::kGroups && sums_.group_weight[g] > 0; ++g)
      add_up([&](std::size_t i) { return of_group(g, i); },
             [g](GroupedMean& side) -> Spectrum& { return side.groups[g].irradiance; });
    for (GroupedMean& side : sides_) {
      if (!(side.area > 0)) continue;
      if (sums_.batches > 0) side.all.irradiance /= side.area * static_cast<double>(sums_.weight());
      for (std::size_t g = 0; g < ZoneSums::kGroups && sums_.group_weight[g] > 0; ++g)
        side.groups[g].irradiance /= side.area * static_cast<double>(sums_.group_weight[g]);
    }
  }

  /// What zones reflect is not the mean reflectance times the mean irradiance.
  void add_what_zones_reflect_beyond_the_mean() {
    // Reflectance of a zone over that of its material, which scatter() takes.
    const auto excess = [&](std::size_t i) {
      const ZoneId z(i / sums_.channels.count());
      const std::size_t band = i % bands_;  // of each group the same
      const Spectrum& mean = solution_.zone_material(z).reflectance_of(mesh_.zone_shows_front(z));
      return solution_.zone_reflectance(z, band) - mean[static_cast<Eigen::Index>(band)];
    };
    add_up([&](std::size_t i) { return excess(i) * sums_.total(i); },
           [](GroupedMean& side) -> Spectrum& { return side.all.reflected; });
    for (std::size_t g = 0; g < ZoneSums::kGroups && sums_.group_weight[g] > 0; ++g)
      add_up([&](std::size_t i) { return excess(i) * of_group(g, i); },
             [g](GroupedMean& side) -> Spectrum& { return side.groups[g].reflected; });
    const auto own = [](GroupedMean::Light& light, const GroupedMean& side, double weight) {
      if (side.area > 0 && weight > 0) light.scattered += light.reflected / (side.area * weight);
    };
    for (GroupedMean& side : sides_) {
      own(side.all, side, static_cast<double>(sums_.weight()));
      for (std::size_t g = 0; g < ZoneSums::kGroups; ++g)
        own(side.groups[g], side, static_cast<double>(sums_.group_weight[g]));
    }
  }

  const Solution& solution_;
  const ZoneMesh& mesh_;
  const ZoneSums& sums_;
  std::size_t bands_;
  std::vector<GroupedMean> sides_;
};

/// Weights of the groups that have batches.
struct GroupWeights {
  explicit GroupWeights(const ZoneSums& sums) {
    for (const std::int64_t weight : sums.group_weight) {
      const auto w = static_cast<double>(weight);
      sum += w;
      of_squares += w * w;
    }
  }
  double sum = 0;
  double of_squares = 0;
};

/// `value_of` is linear in the light, but for a constant: it takes the mean or that of a group. The error is
/// that of a ratio estimate, as ZoneSums has it for batches. `of_one_packet`: the light that one brings. The
/// spread of batches knows nothing of packets that might have come, and little of few that did: the variance
/// is that of one more, so that n packets leave n + 1 times the square of what one brings.
template <class Function>
Estimate estimate(const ZoneSums& sums, const GroupedMean& light, const GroupedMean::Light& of_one_packet,
                  Function&& value_of) {
  const double mean = value_of(light.all);
  if (sums.batches == 0) return {mean, 0};
  if (sums.batches == 1) return {mean, std::numeric_limits<double>::infinity()};
  const GroupWeights weights(sums);
  double squares = 0;
  for (std::size_t g = 0; g < ZoneSums::kGroups && sums.group_weight[g] > 0; ++g) {
    const double deviation = static_cast<double>(sums.group_weight[g]) * (value_of(light.groups[g]) - mean);
    squares += deviation * deviation;
  }
  const Spectrum none = Spectrum::Zero(light.emitted.size());
  const double of_one = value_of(of_one_packet) - value_of(GroupedMean::Light{none, none, none});
  return {mean, std::hypot(std::sqrt(squares / (weights.sum * weights.sum - weights.of_squares)), of_one)};
}

MeanLight finished(const Solution& solution, const GroupedMean& grouped, const Spectrum& watts_per_ray) {
  using Light = GroupedMean::Light;
  const Spectrum& efficacy = solution.bands.efficacy_lm_per_w();
  Light of_one_packet{Spectrum::Zero(efficacy.size()), Spectrum::Zero(efficacy.size()), {}};
  if (grouped.met_by_packets && grouped.area > 0) {
    of_one_packet.irradiance = watts_per_ray / grouped.area;
    of_one_packet.scattered = grouped.scatters * of_one_packet.irradiance;
  }
  const auto of = [&](auto&& value_of) { return estimate(solution.sums, grouped, of_one_packet, value_of); };
  MeanLight light;
  light.area = grouped.area;
  for (Eigen::Index b = 0; b < efficacy.size(); ++b) {
    light.irradiance.push_back(of([&](const Light& e) { return e.irradiance[b]; }));
    // A black surface reflects nothing however little is known about its irradiance.
    const double own = grouped.emitted[b];
    light.exitance.push_back(grouped.scatters[b] > 0
                                 ? of([&](const Light& e) { return own + e.scattered[b]; })
                                 : Estimate{own, 0});
  }
  light.illuminance = of([&](const Light& e) { return (efficacy * e.irradiance).sum(); });
  const double own = (efficacy * grouped.emitted).sum();
  light.luminous_exitance = (grouped.scatters > 0).any()
                                ? of([&](const Light& e) { return own + (efficacy * e.scattered).sum(); })
                                : Estimate{own, 0};
  return light;
}

}  // namespace

Spectrum incident_power_per_ray(const Solution& solution, Solution::Irradiance irradiance) {
  const auto bands = static_cast<Eigen::Index>(solution.bands.count());
  Spectrum power = Spectrum::Zero(bands);
  const std::uint64_t rays = solution.record.rays - solution.gathered.rays;
  if (solution.record.packets == 0 || rays == 0 || solution.sums.batches == 0) return power;
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    for (Eigen::Index b = 0; b < bands; ++b)
      power[b] += solution.mesh.zone_area(ZoneId(z)) *
                  (solution.*irradiance)(ZoneId(z), static_cast<std::size_t>(b)).mean;
  return power / static_cast<double>(rays);
}

RoomLight mean_light(const Solution& solution) {
  const std::vector<GroupedMean> sides = Sides(solution).gather();
  std::vector<GroupedMean> by_material(solution.materials.size(), GroupedMean(solution.bands.count()));
  const Spectrum watts_per_ray = incident_power_per_ray(solution);
  RoomLight room;
  for (std::size_t s = 0; s < solution.surface_names.size(); ++s) {
    const MaterialId material = solution.surface_materials[s];
    const bool dark = sides[2 * s].dark() && sides[2 * s + 1].dark();
    for (const bool front : {true, false}) {
      const GroupedMean& side = sides[2 * s + (front ? 0 : 1)];
      if (!(side.area > 0)) continue;
      const bool counts = dark ? front : !side.dark();
      if (counts) by_material[material.index()].merge(side);
      room.sides.push_back({SurfaceId(s), front, counts, finished(solution, side, watts_per_ray)});
    }
  }
  for (const GroupedMean& material : by_material)
    room.materials.push_back(finished(solution, material, watts_per_ray));
  const GroupWeights weights(solution.sums);
  if (solution.sums.batches > 1) room.degrees_of_freedom = weights.sum * weights.sum / weights.of_squares - 1;
  return room;
}

}  // namespace reemit
