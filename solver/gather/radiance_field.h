#pragma once
#include <cstddef>
#include <vector>

#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// What gather rays read: the zone solution as flat float arrays, all values per band.
class RadianceField {
 public:
  /// `parts`: independent parts of the zone solution that can be read one by one, a power of two, at most
  /// ZoneSums::kGroups. A solution with fewer batches has fewer, down to one. Throws InputError when the room
  /// is not the one that was solved (bands or surfaces differ). The room must outlive it.
  RadianceField(const Room& room, const Solution& solution, std::size_t parts = 1);

  const Room& room() const { return *room_; }
  std::size_t band_count() const { return bands_; }
  /// Parts that there are: one (the whole solution) or independent estimates from disjoint sets of batches.
  std::size_t parts() const { return parts_; }

  /// Reflected radiance rho E/pi of a zone, and what comes through diffusely, tau/pi
  /// times that of the other side [W/(m2 sr)]; self-emission is not in it. Zero where there is no zone.
  const float* reflected(ZoneId zone, std::size_t part = 0) const {
    return zone.valid() ? &reflected_[part * values_ + zone.index() * bands_] : zero_.data();
  }
  /// Of one band, the mean over all parts.
  float mean_reflected(ZoneId zone, std::size_t band) const;
  /// The share of E_direct in reflected(), from all parts [W/(m2 sr)].
  const float* reflected_direct(ZoneId zone) const {
    return zone.valid() ? &reflected_direct_[zone.index() * bands_] : zero_.data();
  }
  /// The share of E_caustic, likewise.
  const float* reflected_caustic(ZoneId zone) const {
    return zone.valid() && !reflected_caustic_.empty() ? &reflected_caustic_[zone.index() * bands_]
                                                       : zero_.data();
  }
  /// Whether of what zones reflect one part in 200 or more came over mirrors, gloss and glass in a room where
  /// rays from surfaces do not find all of such light: that of lights without area, and most of that of the
  /// sun.
  bool has_light_that_rays_miss() const;
  /// Edge length of the square that two zones such as this make up [normalised units].
  float zone_size(ZoneId z) const;

 private:
  /// Of all that zones reflect, the share that caustics brought, of the worst band [0,1].
  double caustic_share() const;
  void read_zones(const Solution& solution);
  /// Of a zone in a part, whose batches weigh `weight` together [W/m2].
  float irradiance(const ZoneSums& sums, std::size_t part, double weight, std::size_t zone,
                   std::size_t band) const;
  void add_transmitted(const Solution& solution, const std::vector<double>& part_weight);

  const Room* room_;
  std::size_t bands_;
  std::size_t parts_;
  std::size_t values_ = 0;        // zones * bands
  std::vector<float> reflected_;  // by part, then by zone
  std::vector<float> reflected_direct_;
  std::vector<float> reflected_caustic_;  // empty where there is none
  std::vector<float> zero_;
};

}  // namespace reemit
