#include "viewer_export/still/room_exposure.h"

#include <algorithm>
#include <cmath>

#include "viewer_export/still/default_cameras.h"
#include "viewer_export/still/render_still.h"

namespace reemit {
namespace {

constexpr double kPixels = 3072;  // 64 x 48
/// The log-average falls by half the variance of noisy pixels; with these many it is a few hundredths of a
/// stop.
constexpr int kSamples = 16;

}  // namespace

ToneMap tone_map_of_room(const Room& room, const Solution& solution, const ToneMapSettings& settings,
                         int threads, const std::atomic<bool>& interrupt) {
  if (settings.exposure_ev) return make_tone_map({}, settings);
  const std::vector<Camera>& cameras = room.scene().cameras;
  const Camera camera = cameras.empty() ? default_cameras(room).front() : cameras.front();
  const double shrink = std::sqrt(kPixels / (static_cast<double>(camera.width) * camera.height));
  StillSettings still;
  still.width = std::max(1, static_cast<int>(std::lround(shrink * camera.width)));
  still.height = std::max(1, static_cast<int>(std::lround(shrink * camera.height)));
  still.spp = kSamples;
  still.threads = threads;
  return make_tone_map(rgb_of(render_still(room, solution, camera, still, {}, interrupt)), settings);
}

}  // namespace reemit
