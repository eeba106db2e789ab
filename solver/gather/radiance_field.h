#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// What gather rays read: the zone solution and the materials as flat float arrays, all values per band.
class RadianceField {
 public:
  /// `parts`: independent parts of the zone solution that can be read one by one, a power of two, at most
  /// ZoneSums::kGroups. A solution with fewer batches has fewer, down to one. Throws InputError when the room
  /// is not the one that was solved (bands or surfaces differ).
  RadianceField(const Scene& scene, const Solution& solution, const RayScene& rays, std::size_t parts = 1);

  std::size_t band_count() const { return bands_; }
  /// Parts that there are: one (the whole solution) or independent estimates from disjoint sets of batches.
  std::size_t parts() const { return parts_; }

  static constexpr std::size_t kNoZone = std::numeric_limits<std::size_t>::max();
  /// Number of the zone at a point; kNoZone on sides that have none.
  std::size_t zone_number(std::size_t triangle, float u, float v, bool front) const {
    const TriangleSide& side = sides_[2 * triangle + (front ? 0 : 1)];
    return side.divisions == 0 ? kNoZone : side.first_zone + zone_in_triangle(side.divisions, u, v);
  }
  /// Reflected radiance rho (E_direct + E_indirect)/pi [W/(m2 sr)] of the zone at a point; self-emission is
  /// not in it. Zero on sides that have no zones.
  const float* reflected(std::size_t triangle, float u, float v, bool front, std::size_t part = 0) const {
    return zone_value(&reflected_[part * values_], triangle, u, v, front);
  }
  /// The same of a zone that is known by its number.
  const float* reflected(ZoneId zone, std::size_t part) const {
    return &reflected_[part * values_ + zone.index() * bands_];
  }
  /// The share rho E_direct/pi of reflected(), from all parts [W/(m2 sr)].
  const float* reflected_direct(std::size_t triangle, float u, float v, bool front) const {
    return zone_value(reflected_direct_.data(), triangle, u, v, front);
  }
  const float* reflected_direct(ZoneId zone) const { return &reflected_direct_[zone.index() * bands_]; }
  /// Self-emitted radiance [W/(m2 sr)] of one side of a triangle: exitance over pi, which is the radiance in
  /// every direction where emission is Lambertian. Zero where it does not emit.
  const float* emitted(std::size_t triangle, bool front) const {
    const TriangleSide& side = sides_[2 * triangle + (front ? 0 : 1)];
    return side.emits ? &surface_emitted_[side.surface * bands_] : zero_.data();
  }
  /// Radiance at an angle to the normal over emitted(): (e+2)/2 cos^e, 1 for Lambertian emission.
  float emission_shape(std::size_t triangle, float cosine) const {
    const float e = surface_exponent_[sides_[2 * triangle].surface];
    return e == 0 ? 1.0F : (0.5F * e + 1) * std::pow(cosine, e);
  }
  /// Diffuse reflectance [0,1] of one side of a triangle; zero on backs that absorb.
  const float* reflectance(std::size_t triangle, bool front) const {
    const TriangleSide& side = sides_[2 * triangle + (front ? 0 : 1)];
    return side.divisions == 0 ? zero_.data() : &surface_reflectance_[side.surface * bands_];
  }
  /// Edge length of the square that two zones of this triangle make up [normalised units].
  float zone_size(std::size_t triangle) const { return zone_size_[triangle]; }

 private:
  struct TriangleSide {
    std::size_t first_zone = 0;
    std::uint32_t divisions = 0;  // 0: no zones on this side
    std::uint32_t surface = 0;
    bool emits = false;
  };

  const float* zone_value(const float* values, std::size_t triangle, float u, float v, bool front) const {
    const std::size_t zone = zone_number(triangle, u, v, front);
    return zone == kNoZone ? zero_.data() : values + zone * bands_;
  }
  void read_surfaces(const Scene& scene);
  void read_zones(const Solution& solution);

  std::size_t bands_;
  std::size_t parts_;
  std::size_t values_ = 0;           // zones * bands
  std::vector<TriangleSide> sides_;  // front, back of each triangle
  std::vector<float> reflected_;     // by part, then by zone
  std::vector<float> reflected_direct_;
  std::vector<float> surface_emitted_;
  std::vector<float> surface_exponent_;
  std::vector<float> surface_reflectance_;
  std::vector<float> zone_size_;
  std::vector<float> zero_;
};

}  // namespace reemit
