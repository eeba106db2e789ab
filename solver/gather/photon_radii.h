#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "scenes/model/stop_token.h"
#include "solver/gather/caustic_photons.h"
#include "solver/gather/photon_grid.h"

namespace reemit {

/// Radius of the kernel of a photon [normalised: half the longest side of the room is 1], from a byte: 0 for
/// the largest, each step a 24th of an octave less.
inline constexpr float kLargestPhotonRadius = 0.025F;
/// [normalised], in (0, kLargestPhotonRadius].
float photon_radius(std::uint8_t code);

/// Photons of all parts together that lie in the radius of one, if that is not the largest.
inline constexpr int kPhotonsInRadius = 160;

/// Radii that halve from one to the next, from the largest on.
inline constexpr std::size_t kRadiusLevels = 6;
/// [normalised]. Pre: level < kRadiusLevels.
constexpr float radius_of_level(std::size_t level) {
  return kLargestPhotonRadius / static_cast<float>(1U << level);
}
/// By level, the photons of all radii down to half that of the level.
std::array<PhotonGrid, kRadiusLevels> grids_by_radius(const CausticPhotons& photons);
/// Epanechnikov's kernel over a disk [per square unit] at this squared distance, below the squared radius.
inline float photon_kernel(float squared_distance, float radius) {
  const float r2 = radius * radius;
  return 2 / (std::numbers::pi_v<float> * r2) * (1 - squared_distance / r2);
}

/// The last level whose radius is not smaller. Photons are counted within that of this level to find the
/// radius, if they lie about evenly.
std::size_t level_of_radius(float radius);

/// Sets the radii of photons by how densely those of a pilot lie around them.
class PhotonRadii {
 public:
  /// `share`: packets of the pilot over those of all parts together.
  PhotonRadii(CausticPhotons pilot, float share);

  /// Sets CausticPhotons::radius_codes of all parts. When `stop` (may be null) is requested some may be those
  /// of others.
  void set(std::span<CausticPhotons> parts, const StopToken* stop) const;

 private:
  /// One of some parts.
  struct Photon {
    std::uint32_t part, number;
    auto operator<=>(const Photon&) const = default;
  };
  class Neighbours;
  /// `levels`: with photons enough at a place nearby, from the largest on; becomes that of this place.
  float radius_at(const CausticPhotons::Place& place, std::size_t& levels) const;

  CausticPhotons pilot_;
  float enough_;  // photons of the pilot in the radius
  std::array<PhotonGrid, kRadiusLevels> grids_;
};

}  // namespace reemit
