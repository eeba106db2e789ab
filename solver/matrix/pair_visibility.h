#pragma once
#include <cstdint>

#include "solver/matrix/polygon_form_factor.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Share of an unoccluded form factor that really arrives.
struct VisibleShare {
  double share = 1;      ///< [0,1]
  double variance = 0;   ///< Of the share; 0 if none of the rays that count arrived.
  bool sampled = false;  ///< Some rays were blocked and some were not.
  std::uint32_t rays = 0;
};

/// Looks from zone to zone with shadow rays. First looks only decide how many rays the estimate gets, and are
/// no part of it, so that the choice does not bias it. They go between all corners (where one straight edge
/// cuts the view, the side on which a line passes it is linear in either end, so some of these differ) and
/// between 8 to 64 well-spread points of both zones. If they differ, the share comes from 8 independent
/// scrambles of 32 to 128 rays; if they agree, from one of 64 to 512. More rays go to pairs with a large form
/// factor. These rays leave uniform points of one zone in directions uniform in the solid angle of the other
/// and are weighted by the cosine: the weights are bounded even where zones touch.
class PairVisibility {
 public:
  PairVisibility(const RayTracer& rays, std::uint64_t seed) : rays_(&rays), seed_(seed) {}

  /// `factor`: the larger of the two unoccluded form factors of the pair.
  VisibleShare look(ZoneId i, ZoneId j, const FacingPair& pair, double factor) const;

 private:
  const RayTracer* rays_;
  std::uint64_t seed_;
};

}  // namespace reemit
