#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "bench/validation/solved_room.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"

namespace reemit::validation {

/// Flat base triangle whose front faces along `normal` (within 1e-3) and that holds `point` [m], as a point
/// on it. Throws std::out_of_range when there is none.
SurfacePoint point_on(const RayTracer& rays, const Vec3& point, const Vec3& normal);

/// Work per replicate.
struct GatherEffort {
  int light_samples = 64;  ///< Powers of two.
  int gather_rays = 1024;  ///< A multiple of light_samples.
};

/// `rays_each` gather rays for each of the shadow rays, at full work; less work has fewer, one at least.
GatherEffort gather_effort(int shadow_rays, double rays_each, const Effort& effort);

/// Irradiance by the final gather, as vertices and pixels have it, at given points: direct light plus
/// cosine-distributed rays that read the zone solution (`close_hit`: see GatherSettings). Replicate r reads
/// batch r of the SolvedRoom alone and has random numbers of its own, so that the spread of replicates holds
/// all noise.
class PointGather {
 public:
  PointGather(const SolvedRoom& room, std::uint64_t seed, double close_hit = 1.0);

  /// At a point of the room's surfaces.
  Estimates at(const Vec3& point, const Vec3& normal, const GatherEffort& effort, std::size_t band = 0) const;
  /// Area mean over the fronts of surfaces: every light sample at a point of its own, stratified over the
  /// area.
  Estimates mean(const std::vector<SurfaceId>& surfaces, const GatherEffort& effort,
                 std::size_t band = 0) const;
  /// The same for all bands at once: every ray carries them all.
  std::vector<Estimates> means(const std::vector<SurfaceId>& surfaces, const GatherEffort& effort) const;

 private:
  template <class PlaceOf>
  std::vector<Estimates> gather(std::uint64_t index, const GatherEffort& effort,
                                const PlaceOf& place_of) const;

  const SolvedRoom* room_;
  std::uint64_t seed_;
  DirectLight direct_;
  std::vector<RadianceField> fields_;      // by solve
  std::vector<HemisphereGather> gathers_;  // by solve
};

/// Direct irradiance [W/m2] at a point in kReplicates independent estimates of `samples` shadow rays each.
Estimates direct_irradiance(const Room& room, const SurfacePoint& x, int samples, std::uint64_t seed);

/// Irradiance [W/m2] at a point without zones, by DirectLight and PathTracer; `effort` as for PointGather.
Estimates traced_irradiance(const Room& room, const SurfacePoint& x, const GatherEffort& effort,
                            std::uint64_t seed, std::size_t band = 0);

/// Relative bound of what single precision and ray starts 1e-6 of the room off their surface do to light at
/// points.
inline constexpr double kPointBound = 2e-5;

}  // namespace reemit::validation
