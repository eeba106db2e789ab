#include "viewer_export/still/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace reemit {
namespace {

/// Half of a pixel, half of the mean of 3 x 3 pixels (fewer at the rim).
double judged_error(const SampledPixels& pixels, int x, int y) {
  const auto at = [&](int u, int v) {
    return pixels.squared_error[static_cast<std::size_t>(v) * static_cast<std::size_t>(pixels.width) +
                                static_cast<std::size_t>(u)];
  };
  double sum = 0;
  int count = 0;
  for (int v = std::max(0, y - 1); v <= std::min(pixels.height - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(pixels.width - 1, x + 1); ++u, ++count) sum += at(u, v);
  return 0.5 * (at(x, y) + sum / count);
}

/// What pixels wish for, relative to each other: standard deviation of a sample over the samples they have.
std::vector<double> wishes(const SampledPixels& pixels) {
  std::vector<double> wishes;
  wishes.reserve(pixels.squared_error.size());
  for (int y = 0; y < pixels.height; ++y)
    for (int x = 0; x < pixels.width; ++x)
      wishes.push_back(
          std::sqrt(judged_error(pixels, x, y) / static_cast<double>(pixels.samples[wishes.size()])));
  return wishes;
}

/// Pixels get `scale` times what they wish for.
SamplePlan plan_of_scale(const SampledPixels& pixels, const std::vector<double>& wishes, double scale) {
  SamplePlan plan;
  plan.doublings.resize(wishes.size());
  for (std::size_t p = 0; p < wishes.size(); ++p) {
    int doublings = 0;
    while (doublings < SamplePlan::kMostDoublings && scale * wishes[p] > 1 << doublings) ++doublings;
    plan.doublings[p] = static_cast<std::uint8_t>(doublings);
    plan.rays += static_cast<double>(pixels.samples[p]) * ((1 << doublings) - 1);
    plan.squared_error += pixels.squared_error[p] / (1 << doublings);
  }
  plan.squared_error /= static_cast<double>(wishes.size());
  return plan;
}

}  // namespace

SamplePlan plan_samples(const SampledPixels& pixels, double target, double most_rays) {
  const std::vector<double> wished = wishes(pixels);
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const double w : wished) {
    if (w > 0) least = std::min(least, w);
    most = std::max(most, w);
  }
  const auto is_wanted = [&](const SamplePlan& plan) {
    return plan.rays <= most_rays && plan.squared_error > target;
  };
  SamplePlan fewer = plan_of_scale(pixels, wished, 0);
  if (!(most > 0) || !is_wanted(fewer)) return fewer;
  double low = 1 / most;                                    // up to here none gets more than it has
  double high = (1 << SamplePlan::kMostDoublings) / least;  // from here on all get the most
  SamplePlan more = plan_of_scale(pixels, wished, high);
  if (is_wanted(more)) return more;
  constexpr double kClose = 1.02;
  while (high > kClose * low) {
    const double middle = std::sqrt(low * high);
    SamplePlan plan = plan_of_scale(pixels, wished, middle);
    const bool wanted = is_wanted(plan);
    (wanted ? low : high) = middle;
    (wanted ? fewer : more) = std::move(plan);
  }
  return more.rays <= most_rays ? more : fewer;
}

}  // namespace reemit
