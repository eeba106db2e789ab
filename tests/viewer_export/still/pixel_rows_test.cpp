#include "viewer_export/still/pixel_rows.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

std::vector<float> random_row(std::size_t count, int seed) {
  std::mt19937 random(static_cast<std::uint32_t>(seed));
  std::uniform_real_distribution<float> uniform(0.1F, 2.0F);
  std::vector<float> row(count);
  for (float& x : row) x = uniform(random);
  return row;
}

// Rows shorter than the mean is wide, and lengths that no register divides.
TEST(PixelRows, means_along_a_row_end_where_it_ends) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{2}, std::size_t{6}, std::size_t{7}, std::size_t{61}}) {
    const std::vector<float> row = random_row(count, 1);
    std::vector<float> mean(count);
    constexpr int kReach = 3;
    pixel_rows::average_along(mean.data(), row.data(), kReach, count);
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0;
      int terms = 0;
      for (std::size_t j = 0; j < count; ++j)
        if (j + kReach >= i && j <= i + kReach) {
          sum += static_cast<double>(row[j]);
          ++terms;
        }
      EXPECT_NEAR(mean[i], sum / terms, 1e-5) << i << " of " << count;
    }
  }
}

TEST(PixelRows, means_across_rows) {
  constexpr std::size_t kRows = 5, kStride = 40, kCount = 37;
  const std::vector<float> picture = random_row(kRows * kStride, 2);
  std::vector<float> mean(kCount);
  pixel_rows::average_across(mean.data(), picture.data(), kRows, kStride, kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < kRows; ++j) sum += static_cast<double>(picture[j * kStride + i]);
    EXPECT_NEAR(mean[i], sum / kRows, 1e-5);
  }
}

TEST(PixelRows, differences_count_what_noise_does_not_explain) {
  // Two pixels 3 apart, of variance 1 and 2: (9 - (1 + 1)) / (4 (1 + 2)), and half of it.
  const float p = 5, q = 2, vp = 1, vq = 2;
  float sum = 1;
  pixel_rows::add_differences(&sum, {&p, &vp}, {&q, &vq}, {.share = 0.5F, .strength = 2, .noise = 1}, 1);
  EXPECT_NEAR(sum, 1 + 0.5 * 7.0 / 12, 1e-4);
  // Equal pixels are nearer than noise lets one expect.
  sum = 0;
  pixel_rows::add_differences(&sum, {&p, &vp}, {&p, &vq}, {.share = 1, .strength = 2, .noise = 1}, 1);
  EXPECT_NEAR(sum, -2.0 / 12, 1e-4);
  // Half of it if they share half of their noise.
  sum = 0;
  pixel_rows::add_differences(&sum, {&p, &vp}, {&p, &vq}, {.share = 1, .strength = 2, .noise = 0.5F}, 1);
  EXPECT_NEAR(sum, -1.0 / 12, 1e-4);
}

TEST(PixelRows, differences_are_the_same_from_either_pixel) {
  const float p = 5, q = 2, vp = 1, vq = 2;
  float from_p = 0;
  float from_q = 0;
  const pixel_rows::DifferenceScales scales{.share = 1, .strength = 0.6F, .noise = 1};
  pixel_rows::add_differences(&from_p, {&p, &vp}, {&q, &vq}, scales, 1);
  pixel_rows::add_differences(&from_q, {&q, &vq}, {&p, &vp}, scales, 1);
  EXPECT_EQ(from_p, from_q);
}

TEST(PixelRows, a_pixel_differs_from_the_mean_of_two) {
  // 5 from the mean of 2 and 4, whose variance is (2 + 6) / 4: (4 - (1 + 1)) / (4 (1 + 2)).
  const float p = 5, q = 2, r = 4, vp = 1, vq = 2, vr = 6;
  float sum = 0;
  const pixel_rows::DifferenceScales scales{.share = 1, .strength = 2, .noise = 1};
  pixel_rows::add_pair_differences(&sum, {&p, &vp}, {&q, &vq}, {&r, &vr}, scales, 1);
  EXPECT_NEAR(sum, 2.0 / 12, 1e-4);
  // On a slope it does not, but for noise.
  const float below = 4, above = 6;
  sum = 0;
  pixel_rows::add_pair_differences(&sum, {&p, &vp}, {&below, &vq}, {&above, &vr}, scales, 1);
  EXPECT_NEAR(sum, -2.0 / 12, 1e-4);
}

TEST(PixelRows, larger_and_smaller_of_two_rows) {
  const std::vector<float> a = random_row(61, 3);
  const std::vector<float> b = random_row(61, 4);
  std::vector<float> larger = a;
  std::vector<float> smaller = a;
  pixel_rows::raise(larger.data(), b.data(), b.size());
  pixel_rows::lower(smaller.data(), b.data(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(larger[i], std::max(a[i], b[i]));
    EXPECT_EQ(smaller[i], std::min(a[i], b[i]));
  }
}

TEST(PixelRows, things_differ_by_normal_or_depth) {
  const float up[] = {0, 0, 1}, aside[] = {0, 0.6F, 0.8F};
  const float depth = 2, deeper = 2.5F, slope = 0.1F, none = 0;
  const pixel_rows::Things here{{&up[0], &up[1], &up[2]}, &depth, &slope, &none};
  const pixel_rows::Things turned{{&aside[0], &aside[1], &aside[2]}, &depth, &slope, &none};
  const pixel_rows::Things behind{{&up[0], &up[1], &up[2]}, &deeper, &slope, &none};
  const pixel_rows::ThingScales scales{.normals = 0.5F, .depth = 0.05F, .columns = 2, .rows = 3};
  float distance = 0;
  pixel_rows::find_distances(&distance, here, turned, scales, 1);
  EXPECT_NEAR(distance, (0.36 + 0.04) / 0.25, 1e-5);
  pixel_rows::find_distances(&distance, here, behind, scales, 1);
  EXPECT_NEAR(distance, 1, 1e-5);  // 0.5 m, of which 0.1 m + 2 (2 * 0.1 m) count as 1
}

TEST(PixelRows, weights_fall_to_nothing) {
  const float distances[] = {-1, 0, 2, 4, 9}, others[] = {-2, -1, 1, 1, 1}, precision[] = {1, 4, 1, 1, 1};
  float weights[5];
  pixel_rows::weigh(weights, distances, others, 4, precision, 5);
  const float expected[] = {1, 4, 1.0F / 16, 0, 0};
  for (int i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(weights[i], expected[i]) << i;
}

TEST(PixelRows, sums_are_weighted) {
  const std::vector<float> weight = random_row(35, 3), value = random_row(35, 4);
  std::vector<float> sum(35, 1.0F), variance(35, 1.0F);
  pixel_rows::add_weighted(sum.data(), weight.data(), value.data(), 35);
  pixel_rows::add_variances(variance.data(), weight.data(), value.data(), 35);
  for (std::size_t i = 0; i < 35; ++i) {
    EXPECT_FLOAT_EQ(sum[i], 1 + weight[i] * value[i]);
    EXPECT_FLOAT_EQ(variance[i], 1 + weight[i] * weight[i] * value[i]);
  }
}

}  // namespace
}  // namespace reemit
