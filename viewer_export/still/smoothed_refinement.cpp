#include "viewer_export/still/smoothed_refinement.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "viewer_export/still/sample_plan.h"
#include "viewer_export/still/smoothing.h"

namespace reemit {
namespace {

/// Plans aim a little below the target, since what they promise is an estimate.
constexpr double kAim = 0.95;
/// Of the squared error, what a round may leave at least: it cannot know how much is noise of the zones.
constexpr double kLeastLeft = 1.0 / 6;
/// Of what a plan promises, a round whose picture gets better by less shows noise that samples do not lessen.
constexpr double kLeastGain = 0.5;
/// How many rounds there will be is not known: one is taken to be this share of all that is left to do.
constexpr double kRoundShare = 0.7;

/// Of the band whose error is the largest, by pixel; relative.
std::vector<double> squared_errors(const StillImage& image, double error_floor) {
  const std::size_t bands = image.bands.count();
  std::vector<double> worst;
  double worst_sum = -1;
  for (std::size_t b = 0; b < bands; ++b) {
    std::vector<double> errors = relative_scales(image.radiance, bands, b, error_floor);
    double sum = 0;
    for (std::size_t p = 0; p < errors.size(); ++p) {
      errors[p] = std::pow(errors[p] * static_cast<double>(image.radiance_stderr[p * bands + b]), 2);
      sum += errors[p];
    }
    if (sum > worst_sum) worst = std::move(errors);
    worst_sum = std::max(worst_sum, sum);
  }
  return worst;
}

}  // namespace

SmoothedRefinement::SmoothedRefinement(const Film& film, const Settings& settings, const StopToken& stop)
    : film_(film), settings_(settings), stop_(stop), error_(std::numeric_limits<double>::infinity()) {}

std::optional<StillImage> SmoothedRefinement::run(const Render& render) {
  std::optional<StillImage> smoothed;
  double before = std::numeric_limits<double>::infinity();  // squared errors, at the last plan
  double promised = 0;
  double done = 0;
  for (;;) {
    const StillHalves halves = film_.halves();
    if (halves[0].empty()) return smoothed;
    StillImage image = film_.snapshot();
    smooth_still(image, halves, settings_.error_floor, stop_);
    if (stop_.requested()) return smoothed;
    smoothed = std::move(image);
    error_ = smoothed->info.error;
    if (error_ <= settings_.target) return smoothed;
    const double squared_error = error_ * error_;
    is_stalled_ = std::isfinite(before) && before - squared_error < kLeastGain * (before - promised);
    if (is_stalled_) return smoothed;

    double used = 0;
    for (const float samples : smoothed->samples) used += static_cast<double>(samples);
    const std::vector<double> errors = squared_errors(*smoothed, settings_.error_floor);
    SamplePlan plan = plan_samples({smoothed->width, smoothed->height, errors, smoothed->samples},
                                   std::max(std::pow(kAim * settings_.target, 2), kLeastLeft * squared_error),
                                   std::max(0.0, settings_.most_rays - used));
    const std::vector<PixelSamples> blocks = blocks_of(plan.doublings);
    if (blocks.empty()) return smoothed;
    const double from = done;
    done += kRoundShare * (1 - done);
    render(blocks, from, done);
    before = squared_error;
    promised = plan.squared_error;
  }
}

std::vector<PixelSamples> SmoothedRefinement::blocks_of(const std::vector<std::uint8_t>& doublings) const {
  const StillImage& image = film_.image();
  const int replicates = static_cast<int>(film_.replicates());
  const int log2_samples = std::bit_width(static_cast<unsigned>(settings_.most_samples - 1));
  std::vector<PixelSamples> blocks;
  for (const Tile& tile : tiles_of(image.width, image.height)) {
    std::map<std::pair<int, int>, std::vector<std::uint32_t>> groups;  // by samples that pixels have and get
    for (const std::uint32_t p : tile.pixels(image.width)) {
      const int has = static_cast<int>(image.samples[p]) / replicates;
      const int gets = std::min(has << doublings[p], settings_.most_samples) - has;
      if (gets > 0) groups[{has, gets}].push_back(p);
    }
    for (auto& [samples, pixels] : groups)
      blocks.push_back({std::move(pixels),
                        {.first = samples.first,
                         .samples = samples.second,
                         .log2_samples = log2_samples,
                         .replicates = replicates}});
  }
  return blocks;
}

}  // namespace reemit
