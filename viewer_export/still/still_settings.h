#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "scenes/model/camera.h"
#include "solver/emit/selection.h"
#include "viewer_export/still/film.h"

namespace reemit {

enum class Integrator {
  kGather,  ///< Direct light by shadow rays, the rest by gather rays that read the zone solution.
  kPath,    ///< Path tracing: the unbiased reference; reads no zone.
  kZones,   ///< The zone solution as it stands, one value per zone.
};
std::string to_string(Integrator integrator);  ///< "gather", "path" or "zones".

struct StillSettings {
  int width = 0;   ///< [px] 0 = as the camera says, [1, limits::kMostPixels].
  int height = 0;  ///< [px] 0 = as the camera says, [1, limits::kMostPixels].
  Integrator integrator = Integrator::kGather;
  PixelFilter filter = PixelFilter::kBox;
  int spp = 16;     ///< Camera rays per pixel, rounded to a power of two below 8, up to a multiple of 8 above
                    ///< [1, 1048576].
  int gathers = 2;  ///< Gather rays per camera ray [1, 1024]; kPath always follows one.
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
  /// With smooth and an error target: camera rays per pixel, the mean over the picture, at which it is given
  /// up; 0 = never.
  double most_mean_spp = 0;
  /// Take the grain out afterwards (smooth_still). With an error target the smoothed picture has to meet it:
  /// where it does not, at edges of things and borders of shadows, pixels get more samples
  /// (SmoothedRefinement). Not of kZones.
  bool smooth = false;
  double close_hit = 1.0;  ///< GatherSettings::close_hit.
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores. The picture does not depend on it.
};

/// Width and height [pixels]: those of the settings, or of the camera where they are 0.
std::pair<int, int> picture_size(const StillSettings& settings, const Camera& camera);

/// Throws InputError for settings out of range.
void check(const StillSettings& settings);

}  // namespace reemit
