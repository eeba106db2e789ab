#pragma once
#include <cstdint>

#include "solver/matrix/polygon_form_factor.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// Share of an unoccluded form factor that really arrives.
struct VisibleShare {
  double share = 1;      ///< [0,1]
  double variance = 0;   ///< Of the share; 0 if all first rays agreed.
  bool sampled = false;  ///< Some first rays were blocked and some were not.
  std::uint32_t rays = 0;
};

/// Looks from zone to zone with shadow rays. First come 16 to 256 rays between well-spread points of both
/// zones, more for pairs with a large form factor. When all agree the pair counts as clear or as hidden; a
/// blocker, or a gap, that takes up less than about one part in that number can go unseen. When they differ,
/// the share is estimated by 8 independent scrambles of 8 to 128 rays each, from uniform points of one zone
/// in directions uniform in the solid angle of the other, weighted by the cosine: the weights are bounded
/// even where zones touch.
class PairVisibility {
 public:
  PairVisibility(const RayScene& rays, std::uint64_t seed) : rays_(&rays), seed_(seed) {}

  /// `factor`: the larger of the two unoccluded form factors of the pair.
  VisibleShare look(ZoneId i, ZoneId j, const FacingPair& pair, double factor) const;

 private:
  const RayScene* rays_;
  std::uint64_t seed_;
};

}  // namespace reemit
