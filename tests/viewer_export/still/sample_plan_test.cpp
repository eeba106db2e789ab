#include "viewer_export/still/sample_plan.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr int kPlanWidth = 20;
constexpr int kPlanHeight = 15;
constexpr std::size_t kPlanPixels = std::size_t{kPlanWidth} * kPlanHeight;
constexpr double kAnyRays = std::numeric_limits<double>::infinity();

std::size_t pixel_at(int x, int y) {
  return static_cast<std::size_t>(y * kPlanWidth + x);
}

/// A quiet picture with a noisy strip of three columns in its middle.
std::vector<double> noisy_strip(double quiet, double noisy) {
  std::vector<double> errors(kPlanPixels, quiet);
  for (int y = 0; y < kPlanHeight; ++y)
    for (int x = 9; x <= 11; ++x) errors[pixel_at(x, y)] = noisy;
  return errors;
}

double mean_after(const std::vector<double>& errors, const SamplePlan& plan) {
  double sum = 0;
  for (std::size_t p = 0; p < kPlanPixels; ++p) sum += errors[p] / (1 << plan.doublings[p]);
  return sum / kPlanPixels;
}

double rays_of(const std::vector<float>& samples, const SamplePlan& plan) {
  double rays = 0;
  for (std::size_t p = 0; p < kPlanPixels; ++p)
    rays += static_cast<double>(samples[p]) * ((1 << plan.doublings[p]) - 1);
  return rays;
}

TEST(SamplePlan, a_good_picture_gets_nothing) {
  const std::vector<double> errors(kPlanPixels, 0.01);
  const std::vector<float> samples(kPlanPixels, 16.0F);
  const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 0.01, kAnyRays);
  EXPECT_EQ(plan.rays, 0);
  EXPECT_NEAR(plan.squared_error, 0.01, 1e-12);
  const std::vector<double> none(kPlanPixels, 0.0);
  EXPECT_EQ(plan_samples({kPlanWidth, kPlanHeight, none, samples}, 0, kAnyRays).rays, 0);
}

TEST(SamplePlan, even_noise_is_met_evenly) {
  const std::vector<double> errors(kPlanPixels, 0.04);
  const std::vector<float> samples(kPlanPixels, 16.0F);
  const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 0.01, kAnyRays);
  for (const std::uint8_t doublings : plan.doublings) EXPECT_EQ(doublings, 2);
  EXPECT_NEAR(plan.squared_error, 0.01, 1e-9);
  EXPECT_NEAR(plan.rays, 16.0 * 3 * kPlanPixels, 1e-6);
}

TEST(SamplePlan, promises_are_those_of_its_samples_and_meet_the_target) {
  const std::vector<double> errors = noisy_strip(0.0004, 0.09);
  std::vector<float> samples(kPlanPixels, 16.0F);
  for (std::size_t p = 0; p < kPlanPixels; p += 3) samples[p] = 64;
  const double target = 0.2 * std::accumulate(errors.begin(), errors.end(), 0.0) / kPlanPixels;
  const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, target, kAnyRays);
  EXPECT_LE(plan.squared_error, target);
  EXPECT_GT(plan.squared_error, 0.5 * target) << "more than a doubling too much";
  EXPECT_NEAR(plan.squared_error, mean_after(errors, plan), 1e-12);
  EXPECT_NEAR(plan.rays, rays_of(samples, plan), 1e-6);
}

TEST(SamplePlan, the_noisy_strip_costs_less_than_samples_everywhere) {
  const std::vector<double> errors = noisy_strip(0.0004, 0.09);
  const std::vector<float> samples(kPlanPixels, 16.0F);
  const double target = 0.25 * std::accumulate(errors.begin(), errors.end(), 0.0) / kPlanPixels;
  const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, target, kAnyRays);
  EXPECT_LT(plan.rays, 0.4 * 16 * 3 * kPlanPixels) << "two doublings of every pixel would do it";
  EXPECT_GE(plan.doublings[pixel_at(10, 7)], 2);
  EXPECT_EQ(plan.doublings[pixel_at(2, 7)], 0);
}

TEST(SamplePlan, a_quiet_pixel_among_noisy_ones_gets_what_they_need) {
  std::vector<double> errors(kPlanPixels, 0.04);
  errors[pixel_at(10, 7)] = 0;
  const std::vector<float> samples(kPlanPixels, 16.0F);
  const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 0.01, kAnyRays);
  EXPECT_GE(plan.doublings[pixel_at(10, 7)], 1);
}

TEST(SamplePlan, spends_what_there_is_and_no_more) {
  const std::vector<double> errors = noisy_strip(0.01, 0.09);
  const std::vector<float> samples(kPlanPixels, 16.0F);
  for (const double most : {0.0, 0.1 * 16 * kPlanPixels, 2.0 * 16 * kPlanPixels}) {
    const SamplePlan plan = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 1e-9, most);
    EXPECT_LE(plan.rays, most);
  }
  const SamplePlan all = plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 1e-9, kAnyRays);
  for (const std::uint8_t doublings : all.doublings) EXPECT_EQ(doublings, SamplePlan::kMostDoublings);
  // The rays of a fifth more samples are worth a fifth of the strip's doublings at least.
  const SamplePlan some =
      plan_samples({kPlanWidth, kPlanHeight, errors, samples}, 1e-9, 0.2 * 16 * kPlanPixels);
  EXPECT_GT(some.rays, 0.1 * 16 * kPlanPixels);
  EXPECT_LT(some.squared_error, std::accumulate(errors.begin(), errors.end(), 0.0) / kPlanPixels);
}

}  // namespace
}  // namespace reemit
