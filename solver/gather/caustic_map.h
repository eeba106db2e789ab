#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/gather/air_photons.h"
#include "solver/gather/caustic_photons.h"
#include "solver/gather/face_ends.h"
#include "solver/gather/photon_grid.h"
#include "solver/gather/photon_radii.h"
#include "solver/reflect/lobe.h"
#include "solver/room/room.h"
#include "solver/solution/gather_plan.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Points in the air that photons are looked out for at, in the order of their numbers.
struct PointsInAir {
  std::span<const MeasuringPoint> points = {};
  /// By how many times as many packets as on surfaces, >= 1: values at single points are not smoothed.
  int rounds = 1;
};

/// Light of luminaires that comes over mirrors, glass or narrow gloss to points of Lambertian surfaces, by
/// the density of photons near the point [JEN96]: gather rays find a small bright lamp over such a way
/// seldom, and then too much of it. What of a luminaire's light is left to gather rays is a share fixed for
/// its surface, the balance heuristic at a typical radius [VG95, GKDS12]; the two add up to all of it.
///
/// The kernel is Epanechnikov's. Each photon has a radius of its own [SIL86 5.3], set at its place by photons
/// that are not counted themselves, so that about kPhotonsInRadius lie in it, within kLargestPhotonRadius: a
/// caustic is blurred by as much, and a photon spreads the power that it has, no more and no less. With a
/// radius of the point that is asked about, dark points would reach far into the bright edge beside them, and
/// nothing make up for it. Where a face ends, or something stands on it, photons beyond are not counted, and
/// a gain of the photon and one of the point make up for the part of the kernel that is lost there
/// (FaceEnds); on what is much narrower than a photon's radius, that is made smaller.
class CausticMap {
 public:
  /// Shoots the photons: `parts` independent sets, a power of two up to CausticShots::kParts. `known` (may be
  /// null): which of these packets bring any, if found with this seed. The room must outlive it. When `stop`
  /// is requested it ends early and means little.
  /// With `in_air`, add_irradiance may be asked about its points; all packets set out then.
  CausticMap(const Room& room, std::size_t parts, std::uint64_t seed, const CausticPackets* known,
             const StopToken* stop, const PointsInAir& in_air = {});
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
  /// Adds weight[b] times the irradiance [W/m2] at a point in the air of photons of a part to sum[b]: what
  /// left_to_rays() does not leave. Always the same for a point and a part; nothing at points without a
  /// number.
  void add_irradiance(const MeasuringPoint& x, std::size_t part, const float* weight, float* sum) const;

 private:
  /// How a photon spreads its power on its face. Aligned to its size, as what is read and written at once
  /// must be.
  struct alignas(8) Spread {
    float gain = 0;            ///< FaceEnds::Kernel::gain at its place.
    std::uint16_t shrunk = 0;  ///< Its radius over the one it had, in 65,535ths.
    bool walled = false;       ///< Something stands on the face within its radius.

    float radius_of(float before) const { return before * static_cast<float>(shrunk) / 65535; }
  };
  struct Photons {
    CausticPhotons all;
    std::vector<float> radius;  ///< By photon, before spread_of.
    /// By photon: spread_of() where it has been asked for, else a gain of 0.
    std::unique_ptr<std::atomic<Spread>[]> spread;
    /// Of the photons of all radii down to half that of the level.
    std::array<PhotonGrid, kRadiusLevels> grids;
  };
  static Photons of_part(CausticPhotons photons);
  /// Looked for when it is asked for first, most photons lying where no one looks; all threads find the same.
  Spread spread_of(const Photons& photons, std::uint32_t i) const;

  const Room* room_ = nullptr;
  std::optional<FaceEnds> ends_;
  std::vector<float> left_to_rays_;  // by surface
  std::vector<Photons> parts_;
  AirPhotons air_;
};

/// Which part of the light that comes from luminaires over such ways to a point rays from there count.
struct CausticShare {
  const CausticMap* photons = nullptr;  ///< Null: all of it.
  bool none = false;                    ///< With photons: nothing, they are asked for all of it.
  bool all = false;                     ///< With photons: all of it, they tell nothing there.

  float of(SurfaceId luminaire) const {
    if (photons == nullptr || !photons->exists() || all) return 1;
    return none ? 0 : photons->left_to_rays(luminaire);
  }
};

}  // namespace reemit
