#include "viewer_export/still/still_planes.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

/// Reflectance below which a pixel is not divided by its own: there it is not diffuse light that is seen.
constexpr float kLeastAlbedo = 0.02F;
constexpr float kNothing = 1e6F;  ///< Depth [m] of a pixel that sees nothing.
/// Of the depth: a slope is taken to be at most this.
constexpr float kSteepest = 0.1F;

}  // namespace

StillPlanes::StillPlanes(const StillImage& image, const StillHalves& halves)
    : width(image.width), height(image.height), bands(image.bands.count()) {
  const std::size_t n = image.pixel_count();
  for (std::size_t h = 0; h < 2; ++h) irradiance[h].resize(bands * n);
  scale.resize(bands * n);
  direct.resize(bands * n);
  caustic.resize(image.caustic.size());
  variance.resize(bands * n);
  precision.reserve(n);
  depth.resize(n);
  for (std::size_t b = 0; b < bands; ++b) {
    for (std::size_t p = 0; p < n; ++p) {
      const std::size_t k = p * bands + b;
      const std::size_t to = b * n + p;
      scale[to] = std::max(image.albedo[k], kLeastAlbedo);
      for (std::size_t h = 0; h < 2; ++h) irradiance[h][to] = halves[h][k] / scale[to];
      direct[to] = image.direct[k] / scale[to];
      if (!caustic.empty()) caustic[to] = image.caustic[k] / scale[to];
      const float error = image.radiance_stderr[k] / scale[to];
      variance[to] = 2 * error * error;  // of a half
    }
  }
  const float fewest = *std::min_element(image.samples.begin(), image.samples.end());
  for (const float samples : image.samples) precision.push_back(samples / fewest);
  for (std::size_t p = 0; p < n; ++p) depth[p] = std::isfinite(image.depth[p]) ? image.depth[p] : kNothing;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k].resize(n);
    for (std::size_t p = 0; p < n; ++p) normal[k][p] = image.normal[3 * p + k];
  }
  find_slopes();
}

void StillPlanes::find_slopes() {
  slope_x.assign(pixels(), 0.0F);
  slope_y.assign(pixels(), 0.0F);
  const auto slope = [&](std::size_t here, bool has_before, std::size_t before, bool has_after,
                         std::size_t after) {
    const float a = has_before ? std::abs(depth[here] - depth[before]) : kNothing;
    const float b = has_after ? std::abs(depth[here] - depth[after]) : kNothing;
    return std::min({a, b, kSteepest * depth[here]});
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t p = at(x, y);
      const auto row = static_cast<std::size_t>(width);
      slope_x[p] = slope(p, x > 0, p - 1, x + 1 < width, p + 1);
      slope_y[p] = slope(p, y > 0, p - row, y + 1 < height, p + row);
    }
}

}  // namespace reemit
