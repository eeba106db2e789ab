#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/gather/caustic_photons.h"
#include "solver/gather/photon_grid.h"
#include "solver/gather/photon_radii.h"
#include "solver/room/room.h"
#include "solver/trace/air_sheets.h"
#include "solver/trace/measuring_point.h"

namespace reemit {

/// Light of luminaires that comes over mirrors, glass or narrow gloss to points in the air, by the density of
/// the photons that pass the planes of these points (CausticMap has that on surfaces).
class AirPhotons {
 public:
  AirPhotons() = default;  ///< Without photons.
  /// `points`, of which the sheets were made, by number; `parts`: independent estimates, each of photons with
  /// their radii. The room must outlive it.
  AirPhotons(const Room& room, std::span<const MeasuringPoint> points, const AirSheets& sheets,
             std::vector<CausticPhotons> parts);

  /// Adds weight[b] times the irradiance [W/m2] at x of photons of a part to sum[b], of each but for the
  /// share `left_to_rays` of its luminaire, by surface. Nothing at points without a number.
  void add_irradiance(const MeasuringPoint& x, std::size_t part, std::span<const float> left_to_rays,
                      const float* weight, float* sum) const;

 private:
  struct Photons {
    CausticPhotons all;
    std::array<PhotonGrid, kRadiusLevels> grids;
  };
  /// What photons count for at a place of the kernel, over what they count for in the open: the first, and
  /// the others for each radius that the place lies aside. Photons beyond a wall are not of this point's
  /// light, and none come from there, so that those before it count for more, and such that light which rises
  /// or falls along the plane is read as it is at the point.
  using Gain = Eigen::Vector3f;
  /// By step of radius, from the largest down to one within which nothing stands; empty: nothing does anyhow.
  using Gains = std::vector<Gain>;
  Gains gains_at(const MeasuringPoint& x) const;
  /// For a radius of that code.
  static Gain gain_of(const Gains& gains, std::uint8_t code);

  const Room* room_ = nullptr;
  std::vector<std::uint32_t> sheet_;  // by point
  std::vector<Gains> gains_;          // by point
  std::vector<Photons> parts_;
};

}  // namespace reemit
