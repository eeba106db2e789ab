#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "scenes/model/camera.h"
#include "solver/emit/selection.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

enum class Integrator {
  kGather,  ///< Direct light by shadow rays, the rest by gather rays that read the zone solution.
  kPath,    ///< Path tracing: the unbiased reference; reads no zone.
  kZones,   ///< The zone solution as it stands, one value per zone.
};
std::string to_string(Integrator integrator);  ///< "gather", "path" or "zones".

struct StillSettings {
  int width = 0;   ///< [px] 0 = as the camera says, [1, 65536].
  int height = 0;  ///< [px] 0 = as the camera says, [1, 65536].
  Integrator integrator = Integrator::kGather;
  PixelFilter filter = PixelFilter::kBox;
  int spp = 16;     ///< Camera rays per pixel, rounded to a power of two below 8, up to a multiple of 8 above
                    ///< [1, 1048576].
  int gathers = 4;  ///< Gather rays per camera ray [1, 1024]; kPath always follows one.
  int light_samples = 1;  ///< Shadow rays per camera ray [1, 1024].
  /// How shadow rays choose their luminaire; unset: as DirectLight finds best.
  std::optional<Selection> light_selection = std::nullopt;
  /// Relative error to reach as a fraction [0, 1): rms over pixels of s/(L + floor), worst band, with s the
  /// standard error of radiance L. 0 = stop by spp; else spp is ignored.
  double error_target = 0;
  /// `floor` above as a share of the picture's mean radiance [0, 1]: keeps black pixels from asking for more
  /// than anyone can see.
  double error_floor = 0.01;
  int most_spp = 16384;  ///< Camera rays per pixel at which an error target is given up.
  /// Take the grain out afterwards (smooth_still); error_target counts what is there before. Not of kZones.
  bool smooth = false;
  double close_hit = 1.0;  ///< GatherSettings::close_hit.
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores. The picture does not depend on it.
};

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
/// with 7 degrees of freedom, so a 95 % interval is 2.36 standard errors to each side. With an error target,
/// 16 x 16 pixel tiles that have reached it get no more samples, nor do tiles whose error is that of the zone
/// solution (StillImage::limited_by_zones). Bit for bit the same for any number of threads. `progress` (may
/// be empty) is called from one thread at a time. The first samples go over the whole picture one replicate
/// after the other: when `interrupt` becomes true, returns what stands, a noisier picture; tiles that have
/// not had a sample by then hold zone values. Throws InputError for settings or a camera out of range and a
/// room that is not the one solved, ResourceError when the picture does not fit into memory.
StillImage render_still(const Room& room, const Solution& solution, const Camera& camera,
                        const StillSettings& settings, const StillProgressCallback& progress,
                        const std::atomic<bool>& interrupt);

}  // namespace reemit
