#include "viewer_export/output/smoothing_errors.h"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr std::size_t kItems = 4096;
constexpr double kNoise = 0.1;  ///< Of an item before smoothing; the truth is 1.

/// Means over `averaged` items that say of themselves what independent noise would leave, and whose noise is
/// `factor` times that variance.
struct Means {
  explicit Means(std::size_t items) : smoothed(items), before(items, 1.0F), stderrs(items) {}

  void put(std::size_t first, std::size_t last, double averaged, double factor) {
    std::mt19937 random(static_cast<unsigned>(first) + 3);
    std::normal_distribution<double> normal;
    for (std::size_t i = first; i < last; ++i) {
      const double variance = kNoise * kNoise / averaged;
      const double off = std::sqrt(factor * variance);
      smoothed.value[i] = static_cast<float>(1 + off * normal(random));
      // Halves are twice as noisy each, half of their difference as much as their mean.
      smoothed.halves_apart[i] = static_cast<float>(off * normal(random));
      smoothed.variance[i] = smoothed.covariance[i] = static_cast<float>(variance);
      stderrs[i] = static_cast<float>(kNoise);
      before[i] = static_cast<float>(1 + kNoise * normal(random));
    }
  }
  void complete() {
    const std::vector<double> scales(before.size(), 1.0);
    SmoothingErrors errors(smoothed, before, stderrs, 1, 0, scales);
    std::vector<std::size_t> all(before.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    errors.complete(all);
  }
  double mean_variance(std::size_t first, std::size_t last) const {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(smoothed.variance[i]);
    return sum / static_cast<double>(last - first);
  }

  SmoothedValues smoothed;
  std::vector<float> before, stderrs;
};

// Sums of thousands of squares of normal numbers: 4 standard errors are 4 sqrt(2/2048) = 12.5 % at most.
TEST(SmoothingErrors, noise_that_neighbours_share_is_found_and_so_is_noise_that_cancels) {
  for (const double factor : {0.25, 1.0, 3.0}) {
    Means means(kItems);
    means.put(0, kItems, 16, factor);
    const std::vector<double> scales(kItems, 1.0);
    const SmoothingErrors errors(means.smoothed, means.before, means.stderrs, 1, 0, scales);
    EXPECT_NEAR(means.mean_variance(0, kItems) / (factor * kNoise * kNoise / 16), 1, 0.125) << factor;
  }
}

TEST(SmoothingErrors, items_are_told_apart_by_how_much_was_averaged) {
  Means means(kItems);
  means.put(0, kItems / 2, 2, 1);
  means.put(kItems / 2, kItems, 32, 4);
  const std::vector<double> scales(kItems, 1.0);
  const SmoothingErrors errors(means.smoothed, means.before, means.stderrs, 1, 0, scales);
  EXPECT_NEAR(means.mean_variance(0, kItems / 2) / (kNoise * kNoise / 2), 1, 0.125);
  EXPECT_NEAR(means.mean_variance(kItems / 2, kItems) / (4 * kNoise * kNoise / 32), 1, 0.125);
}

TEST(SmoothingErrors, few_means_follow_the_rest) {
  Means means(kItems + 64);
  means.put(0, kItems, 2, 2);
  means.put(kItems, kItems + 64, 32, 0);  // two independent ones, by chance without any noise
  const std::vector<double> scales(kItems + 64, 1.0);
  const SmoothingErrors errors(means.smoothed, means.before, means.stderrs, 1, 0, scales);
  EXPECT_NEAR(means.mean_variance(kItems, kItems + 64) / (2 * kNoise * kNoise / 32), 1, 0.125);
}

TEST(SmoothingErrors, means_that_are_off_are_noticed) {
  Means means(kItems);
  means.put(0, kItems, 64, 1);
  for (float& value : means.smoothed.value) value += 0.5F * static_cast<float>(kNoise);
  means.complete();
  const double expected = kNoise * kNoise * (0.25 + 1.0 / 64);
  EXPECT_NEAR(means.mean_variance(0, kItems), expected, 0.12 * kNoise * kNoise);
}

}  // namespace
}  // namespace reemit
