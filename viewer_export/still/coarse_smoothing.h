#pragma once
#include <array>
#include <vector>

#include "scenes/model/stop_token.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {

/// Irradiance of pixels as in StillPlanes, smoothed: that of each half, and its direct and caustic part; by
/// band (index band * pixels + pixel).
struct SmoothedIrradiance {
  std::array<std::vector<float>, 2> halves;
  std::vector<float> direct, caustic;
};

/// Takes out of a smoothed still with caustics what noise many neighbouring pixels share, that of photons:
/// blotches that are as wide as what pixels are averaged over, and that each look like something there. The
/// still is made small, smoothed once more as pixels are ([DMB14]), and what that changes is added to the
/// pixels, interpolated on each surface; then once more, smaller. How much noise squares of pixels share,
/// their halves tell. `sampled` says where surfaces end. Ends early when `stop` is requested.
void smooth_coarsely(const StillPlanes& sampled, const StopToken& stop, SmoothedIrradiance& smoothed);

}  // namespace reemit
