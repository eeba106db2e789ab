#pragma once
#include <cstdint>
#include <vector>

namespace reemit {

/// What is known of the pixels of a still whose samples are to be shared out.
struct SampledPixels {
  int width;                                 ///< [px]
  int height;                                ///< [px]
  const std::vector<double>& squared_error;  ///< Relative, by pixel.
  const std::vector<float>& samples;         ///< By pixel, camera rays that it has, > 0.
};

/// How many samples each pixel is to have.
struct SamplePlan {
  static constexpr int kMostDoublings = 5;

  std::vector<std::uint8_t> doublings;  ///< By pixel: of its samples [0, kMostDoublings].
  double rays = 0;                      ///< Camera rays that it takes.
  double squared_error = 0;             ///< Mean over the pixels that is expected then.
};

/// Shares samples out so that the mean squared error falls to `target` with as few rays as that takes, or as
/// far as `most_rays` go: the error of n samples falls as 1/n, so n is in proportion to the standard
/// deviation of one sample (Neyman's allocation, [COC77] 5.5), rounded up to a power of two times what there
/// is. A pixel is judged by half its own and half its 3 x 3 surroundings' squared error: one that looks quiet
/// by chance gets what its neighbours need.
SamplePlan plan_samples(const SampledPixels& pixels, double target, double most_rays);

}  // namespace reemit
