#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/gather/caustic_photons.h"
#include "solver/gather/photon_grid.h"
#include "solver/reflect/lobe.h"
#include "solver/room/room.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Light of luminaires that comes over mirrors, glass or narrow gloss to points of Lambertian surfaces, by
/// the density of photons near the point [JEN96]: gather rays find a small bright lamp over such a way
/// seldom, and then too much of it. What of a luminaire's light is left to gather rays is a share fixed for
/// its surface, the balance heuristic at a typical radius [VG95, GKDS12]; the two add up to all of it.
///
/// The kernel is Epanechnikov's. Each photon has a radius of its own [SIL86 5.3], set at its place by photons
/// that are not counted themselves, so that about kPhotons lie in it, within kLargestRadius: a caustic is
/// blurred by as much, and a photon spreads the power that it has, no more and no less. With a radius of the
/// point that is asked about, dark points would reach far into the bright edge beside them, and nothing make
/// up for it. Where a face ends, or something stands on it, photons beyond are not counted, and a gain of the
/// photon and one of the point make up for the part of the kernel that is lost there.
class CausticMap {
 public:
  static constexpr int kPhotons = 160;             ///< In the radius, of all parts together.
  static constexpr float kLargestRadius = 0.025F;  ///< Normalised: of half the longest side of the room.

  /// Shoots the photons: `parts` independent sets. The room must outlive it. When `stop` is requested it ends
  /// early and means little.
  CausticMap(const Room& room, std::size_t parts, std::uint64_t seed, const StopToken* stop);
  CausticMap() = default;  ///< Without photons.

  /// False if no luminaire lights anything over such a way.
  bool exists() const { return !parts_.empty(); }
  /// Share of the light of a surface over such ways that gather rays are to count; 0 for lights without area,
  /// whose surface is not valid.
  float left_to_rays(SurfaceId luminaire) const {
    return luminaire.valid() ? left_to_rays_[luminaire.index()] : 0.0F;
  }
  /// Adds weight[b] brdf(b) times the irradiance [W/m2] at x of photons of a part to sum[b]: what
  /// left_to_rays() does not leave, or all of it if `whole`. `turn` in [0,1) places the points that look for
  /// ends of the face.
  void add_reflected(const SurfacePoint& x, std::size_t part, bool whole, float turn, const BrdfValue& brdf,
                     const float* weight, float* sum) const;

 private:
  static constexpr std::size_t kLevels = 6;  // radii halve from one to the next
  struct Photons {
    CausticPhotons all;
    std::vector<float> radius;  ///< By photon; empty for those that set radii.
    /// By photon: gain_of() where it has been asked for, else 0.
    std::unique_ptr<std::atomic<float>[]> gain;
    /// Of the photons of all radii down to half that of the level; of those that set radii, of all.
    std::array<PhotonGrid, kLevels> grids;
  };
  Photons of_pilot(CausticPhotons photons) const;
  Photons of_part(CausticPhotons photons, const StopToken* stop) const;
  static float radius_of(std::size_t level) { return kLargestRadius / static_cast<float>(1U << level); }
  /// gain_at_end of the place of a photon, below 0 if something stands on the face within its radius. Looked
  /// for when it is asked for first, most photons lying where no one looks; all threads find the same.
  float gain_of(const Photons& photons, std::uint32_t i) const;
  static bool counts(const Photons& photons, std::uint32_t i, const Vec3f& normal, const Vec3f& place,
                     float radius);

  /// `levels`: with photons enough at a place nearby, from the largest on; becomes that of this place.
  float radius_at(const Vec3f& normal, const Vec3f& place, std::size_t& levels) const;
  bool is_beside_wall(const Vec3f& normal, const Vec3f& place, float radius) const;
  bool is_inside_triangle(TriangleId triangle, const Vec3f& place, float radius) const;
  float gain_at_end(const Vec3f& normal, const Vec3f& place, float radius, float turn) const;

  const Room* room_ = nullptr;
  std::vector<float> left_to_rays_;  // by surface
  Photons pilot_;
  float pilot_target_ = 0;  // photons of the pilot in the radius
  std::vector<Photons> parts_;
};

/// Which part of the light that comes from luminaires over such ways to a point rays from there count.
struct CausticShare {
  const CausticMap* photons = nullptr;  ///< Null: all of it.
  bool none = false;                    ///< With photons: nothing, they are asked for all of it.

  float of(SurfaceId luminaire) const {
    if (photons == nullptr || !photons->exists()) return 1;
    return none ? 0 : photons->left_to_rays(luminaire);
  }
};

}  // namespace reemit
