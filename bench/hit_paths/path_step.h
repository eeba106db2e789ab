#pragma once
#include <optional>

#include "bench/hit_paths/path_random.h"
#include "bench/hit_paths/polygon_room.h"

namespace reemit::hit_paths {

/// How a path goes on from a surface.
struct PathStep {
  Vec3 direction{0, 0, 1};
  Spectrum weight;        ///< By band: share of the light, over the chance of this choice.
  bool scatters = false;  ///< Chance chose the direction, not the path before it.
  bool crosses = false;   ///< The surface.
};

/// Chooses one of the ways on: spread evenly on either side, mirrored, or across, each as often as its
/// largest share over the bands says. With `roulette` the path may end, which is what no step means.
std::optional<PathStep> next_step(const RoomHit& hit, const Vec3& direction, bool roulette,
                                  PathRandom& random);

}  // namespace reemit::hit_paths
