#pragma once
#include <array>
#include <vector>

#include "scenes/model/stop_token.h"
#include "viewer_export/still/similar_pixels.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {

/// A picture smoothed a little, which has so little noise left that it tells better than the pixels
/// themselves what is alike: the basic estimate of [DFKE07]. The noise of photons, which neighbours share, is
/// left in it and must not look like light: its variance holds it.
class BasicEstimate {
 public:
  /// Runs in the arena of the caller; ends early when `stop` is requested.
  BasicEstimate(const StillPlanes& planes, const StopToken& stop);

  /// What it tells. The estimate must outlive the guide.
  PixelGuide guide() const;

 private:
  std::array<std::vector<float>, 2> value_;  // of each half, as StillPlanes::irradiance
  std::vector<float> variance_;              // of a half
};

}  // namespace reemit
