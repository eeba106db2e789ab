#pragma once
#include "scenes/model/stop_token.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {

/// Takes out of a smoothed still with caustics what noise many neighbouring pixels share, that of photons:
/// blotches that are as wide as what pixels are averaged over, and that each look like something there. The
/// still is made small, smoothed once more as pixels are ([DMB14]), and what that changes is added to the
/// pixels, interpolated on each surface; then once more, smaller. How much noise squares of pixels share,
/// their halves tell. `smoothed`: with irradiance, direct and caustic part of the smoothed still, which it
/// changes. Ends early when `stop` is requested.
void smooth_coarsely(StillPlanes& smoothed, const StopToken& stop);

}  // namespace reemit
