#pragma once
#include <vector>

#include "scenes/model/camera.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/still/render_still.h"

namespace reemit::bench {

/// Pictures of a room by a solution against those of path tracing, which reads no zone.
class PictureCheck {
 public:
  /// Path traces the room twice from its first camera, or from the first automatic one, 192 pixels wide with
  /// `spp` camera rays per pixel.
  PictureCheck(const Room& room, const Solution& solution, int spp);

  /// Relative rms error of a picture that shows the zones: sqrt(mean d1 d2) / mean r over its pixels, less
  /// the brightest 2 %, which see luminaires; d1 and d2 are the differences of two such pictures to one
  /// reference each, so that the noise of pixels drops out, and r is the mean of the references. 0 if noise
  /// is all there is.
  double error(const Room& room, const Solution& solution) const;

 private:
  std::vector<float> picture(const Room& room, const Solution& solution, StillSettings settings) const;

  Camera camera_;
  int height_ = 0;
  std::vector<float> first_, second_;  ///< Mean over bands by pixel [W/(m2 sr)].
  std::vector<std::size_t> compared_;  ///< Pixels.
};

}  // namespace reemit::bench
