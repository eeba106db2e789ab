#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "scenes/model/stop_token.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/still_image.h"
#include "viewer_export/still/tile_renderer.h"

namespace reemit {

/// Pixels, by number, that get a block of samples.
struct PixelSamples {
  std::vector<std::uint32_t> pixels;
  SampleBlock block;
};

/// A still that is to be smoothed gets more samples where smoothing leaves noise: edges of things, borders of
/// shadows, whose pixels are alike few others. After each round the picture is smoothed and its samples are
/// planned anew, until its error is below the target, the rays are used up or more of them do not help.
class SmoothedRefinement {
 public:
  struct Settings {
    double target;       ///< Relative error of the smoothed picture.
    double error_floor;  ///< As of StillSettings.
    int most_samples;    ///< Of a replicate of a pixel.
    double most_rays;    ///< Camera rays of the whole picture, those that it has included.
  };
  /// Adds these samples; `from` and `to` [0,1] say where they begin and end of all that is left to do.
  /// Returns early once somebody wants to stop.
  using Render = std::function<void(const std::vector<PixelSamples>&, double from, double to)>;

  /// The film must outlive this.
  SmoothedRefinement(const Film& film, const Settings& settings, const StopToken& stop);

  /// Returns the smoothed picture; nothing if it was stopped before there was one, or the film has no halves.
  /// `render` adds to the film.
  std::optional<StillImage> run(const Render& render);

  /// Relative, of the smoothed picture; infinite before there is one.
  double error() const { return error_; }
  /// True if the target was missed although there were rays left: what remains is noise of the zones.
  bool is_stalled() const { return is_stalled_; }

 private:
  /// What the plan adds to the pixels, in groups of pixels of one tile and number of samples.
  std::vector<PixelSamples> blocks_of(const std::vector<std::uint8_t>& doublings) const;

  const Film& film_;
  Settings settings_;
  const StopToken& stop_;
  double error_;
  bool is_stalled_ = false;
};

}  // namespace reemit
