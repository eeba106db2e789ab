#include "bench/zone_plans/picture_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "viewer_export/still/default_cameras.h"

namespace reemit::bench {
namespace {

constexpr int kWidth = 192;                  // [px]
constexpr double kWithoutLuminaires = 0.98;  // of the pixels

}  // namespace

PictureCheck::PictureCheck(const Room& room, const Solution& solution, int spp)
    : camera_(room.scene().cameras.empty() ? default_cameras(room).front() : room.scene().cameras.front()),
      height_(std::max(1, kWidth * camera_.height / camera_.width)) {
  StillSettings settings;
  settings.integrator = Integrator::kPath;
  settings.spp = spp;
  settings.seed = 101;
  first_ = picture(room, solution, settings);
  settings.seed = 102;
  second_ = picture(room, solution, settings);
  compared_.resize(first_.size());
  std::iota(compared_.begin(), compared_.end(), std::size_t{0});
  const auto brightness = [&](std::size_t i) { return first_[i] + second_[i]; };
  const auto kept = static_cast<std::ptrdiff_t>(kWithoutLuminaires * static_cast<double>(compared_.size()));
  std::nth_element(compared_.begin(), compared_.begin() + kept, compared_.end(),
                   [&](std::size_t a, std::size_t b) { return brightness(a) < brightness(b); });
  compared_.resize(static_cast<std::size_t>(kept));
}

std::vector<float> PictureCheck::picture(const Room& room, const Solution& solution,
                                         StillSettings settings) const {
  const std::atomic<bool> never{false};
  settings.width = kWidth;
  settings.height = height_;
  const StillImage image = render_still(room, solution, camera_, settings, {}, never);
  const std::size_t bands = image.bands.count();
  std::vector<float> mean(image.pixel_count());
  for (std::size_t i = 0; i < mean.size(); ++i)
    mean[i] = std::accumulate(&image.radiance[i * bands], &image.radiance[i * bands] + bands, 0.0F) /
              static_cast<float>(bands);
  return mean;
}

double PictureCheck::error(const Room& room, const Solution& solution) const {
  StillSettings settings;
  settings.integrator = Integrator::kZones;
  settings.spp = 256;
  settings.seed = 1;
  const std::vector<float> one = picture(room, solution, settings);
  settings.seed = 2;
  const std::vector<float> other = picture(room, solution, settings);
  double product = 0;
  double mean = 0;
  for (const std::size_t i : compared_) {
    const auto r1 = static_cast<double>(first_[i]);
    const auto r2 = static_cast<double>(second_[i]);
    product += (static_cast<double>(one[i]) - r1) * (static_cast<double>(other[i]) - r2);
    mean += 0.5 * (r1 + r2);
  }
  return std::sqrt(std::max(0.0, product / static_cast<double>(compared_.size()))) *
         static_cast<double>(compared_.size()) / mean;
}

}  // namespace reemit::bench
