#pragma once
#include <atomic>
#include <functional>

#include "scenes/model/camera.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/still/still_image.h"
#include "viewer_export/still/still_light.h"
#include "viewer_export/still/still_settings.h"

namespace reemit {

struct StillProgress {
  double fraction = 0;  ///< Of the work, an estimate [0,1].
  double error = 0;     ///< As error_target; infinite before it is known.
  int samples = 0;      ///< Camera rays per pixel finished where the picture still improves.
  double seconds = 0;
};
using StillProgressCallback = std::function<void(const StillProgress&)>;

/// Renders a picture from eight replicates of each pixel (fewer if spp is smaller). A replicate is an
/// independent randomised quasi-Monte Carlo estimate that is refined block by block and reads its own part of
/// the zone solution, so the spread of the replicates is the standard error, the noise of the zones included:
/// with 7 degrees of freedom, so a 95 % interval is 2.36 standard errors to each side. With an error target
/// for pixels as sampled, 16 x 16 pixel tiles that have reached it get no more samples, nor do tiles whose
/// error is that of the zone solution (StillImage::limited_by_zones); smoothed pictures are refined by
/// SmoothedRefinement. Bit for bit the same for any number of threads. `progress` (may be empty) is called
/// from one thread at a time. The first samples go over the whole picture one replicate after the other: when
/// `interrupt` becomes true, returns what stands, a noisier picture; tiles that have not had a sample by then
/// hold zone values. Throws InputError for a camera or a size out of range, ResourceError when the picture
/// does not fit into memory.
StillImage render_still(const StillLight& light, const Camera& camera, const StillProgressCallback& progress,
                        const std::atomic<bool>& interrupt);

/// The same of a room of which there is one still; throws what StillLight::prepare does as well.
StillImage render_still(const Room& room, const Solution& solution, const Camera& camera,
                        const StillSettings& settings, const StillProgressCallback& progress,
                        const std::atomic<bool>& interrupt);

}  // namespace reemit
