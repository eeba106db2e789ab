#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenes/model/vec.h"
#include "solver/gather/radiance_field.h"

namespace reemit {

/// Zones that are small and send out much of a room's reflected light: the wall beside a cove, the ceiling
/// over an uplight, the inside of an open housing. Of rays that a gather sends anywhere few meet them, and
/// each that does brings much. So some rays are aimed at them, and what rays of either kind find there counts
/// by the balance heuristic [VG95]: density times number of its own kind over the sum of both.
///
/// The zones are kept in clumps. A point weighs each clump by the light it would bring if nothing were in
/// the way, and chooses a zone of it by power and a point of the zone evenly. Const members may be called
/// from any thread.
class BrightZones {
 public:
  static constexpr std::size_t kMostClumps = 32;

  /// How a point weighs the clumps.
  struct View {
    std::array<float, kMostClumps> weight;
    float total = 0;  ///< 0 where none of them can light it.
  };
  /// Where a ray is aimed.
  struct Aim {
    Vec3f direction{0, 0, 1};  ///< Unit.
    TriangleId triangle;       ///< That holds the point aimed at.
    bool front = true;         ///< The side of it.
    float distance = 0;        ///< To that point [normalised]; 0: none was found.
    /// Whether a ray along it that ended so met what it was aimed at: not the other side of a sheet that is
    /// bright on both, whose zone has a density of its own.
    bool is_met(TriangleId t, bool on_front, float length) const {
      constexpr float kSameDistance = 1e-3F;
      return t == triangle && on_front == front && std::fabs(length - distance) <= kSameDistance * distance;
    }
  };

  BrightZones() = default;  ///< None.
  /// Zones from which more than twice as much is reflected as from the mean of the room. None where these
  /// have too little of the variance of a gather ray to be worth rays of their own. They are found by all
  /// parts of the field; which they are has no say in what is gathered on average. The room must outlive it.
  explicit BrightZones(const RadianceField& field);

  bool empty() const { return clumps_ == 0; }
  /// Reflected by any zone of the room, all bands together, the mean over all parts [W/(m2 sr)].
  float radiance(ZoneId zone) const { return radiance_[zone.index()]; }
  /// Pre: not empty().
  bool holds(ZoneId zone) const { return clump_of_[zone.index()] != kNone; }

  /// From a point x (normalised) where light counts by the cosine to the unit normal n. Pre: not empty().
  void view(const Vec3f& x, const Vec3f& n, View& view) const;
  /// From there at a point of a bright zone, for three uniform numbers. Pre: view.total > 0.
  Aim aim(const Vec3f& x, const View& view, const std::array<float, 3>& u) const;
  /// Density with which aim() goes along a ray from x to a point of a bright zone [1/sr]. `total`: of the
  /// view from there. `cosine`: of the ray to the normal of the zone, above 0; `distance`: its length.
  float pdf_per_sr(const Vec3f& x, const Vec3f& n, float total, ZoneId zone, float cosine,
                   float distance) const;

 private:
  static constexpr std::uint8_t kNone = 255;
  float weight(std::size_t clump, const Vec3f& x, const Vec3f& n) const {
    const float dx = x_[clump] - x.x();
    const float dy = y_[clump] - x.y();
    const float dz = z_[clump] - x.z();
    const float r = radius_[clump];
    const float above = n.x() * dx + n.y() * dy + n.z() * dz + r;
    // As far as normals differ, the clump may face x with all its light from wherever it is.
    const float spread = spread_[clump] * (std::fabs(dx) + std::fabs(dy) + std::fabs(dz));
    const float facing = spread - (nx_[clump] * dx + ny_[clump] * dy + nz_[clump] * dz) + r;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float nearest2 = distance2 > r * r ? distance2 : r * r;
    const float lit = above > 0 && facing > 0 ? power_[clump] : 0.0F;
    return lit * above * facing / (nearest2 * nearest2);
  }

  const Room* room_ = nullptr;
  std::vector<ZoneId> zones_;           // by clump
  std::vector<std::uint8_t> clump_of_;  // by zone of the mesh
  std::vector<float> radiance_;         // by zone of the mesh
  std::size_t clumps_ = 0;
  std::array<std::uint32_t, kMostClumps + 1> first_{};                   // zone of each clump, and the end
  std::array<float, kMostClumps> x_{}, y_{}, z_{}, nx_{}, ny_{}, nz_{};  // middle, mean normal
  std::array<float, kMostClumps> spread_{}, radius_{}, power_{};         // of normals; of a sphere around
  std::vector<float> power_to_;                                          // of the zones of a clump up to each
};

}  // namespace reemit
