#include "viewer_export/still/still_planes.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "viewer_export/still/allocate_planes.h"

namespace reemit {
namespace {

/// Reflectance below which a pixel is not divided by its own: there it is not diffuse light that is seen.
constexpr float kLeastAlbedo = 0.02F;
constexpr float kNothing = 1e6F;  ///< Depth [m] of a pixel that sees nothing.
/// Added to normals of luminaires: more than two normals can differ by.
constexpr float kLamp = 4;
/// Added to normals of mirrors, glass and gloss: a little more than what normals of unlike things differ by,
/// so that pixels on the rim of one are like each other.
constexpr float kMirror = 1.25F;
/// Of the depth: a slope is taken to be at most this.
constexpr float kSteepest = 0.1F;

}  // namespace

StillPlanes::StillPlanes(const StillImage& image, const StillHalves& halves)
    : width(image.width), height(image.height), bands(image.bands.count()) {
  const std::size_t n = image.pixel_count();
  std::vector<std::vector<float>*> by_band{&irradiance[0], &irradiance[1], &scale, &direct, &variance};
  if (!image.caustic.empty()) by_band.push_back(&caustic);
  allocate_planes(by_band, bands * n);
  precision.resize(n);
  depth.resize(n);
  sees_luminaire.resize(n);
  for (std::vector<float>& axis : normal) axis.resize(n);
  const float fewest = *std::min_element(image.samples.begin(), image.samples.end());
  // Others for all pixels that may be compared.
  const auto number_nearby = [this](std::size_t p) {
    constexpr std::size_t kSide = 32;
    const auto across = static_cast<std::size_t>(width);
    return p % across % kSide + kSide * (p / across % kSide);
  };
  tbb::parallel_for(0, height, [&](int y) {
    for (std::size_t p = at(0, y); p < at(0, y + 1); ++p) {
      for (std::size_t b = 0; b < bands; ++b) {
        const std::size_t k = p * bands + b;
        const std::size_t to = b * n + p;
        scale[to] = std::max(image.albedo[k], kLeastAlbedo);
        for (std::size_t h = 0; h < 2; ++h) irradiance[h][to] = halves[h][k] / scale[to];
        direct[to] = image.direct[k] / scale[to];
        if (!caustic.empty()) caustic[to] = image.caustic[k] / scale[to];
        const float error = image.radiance_stderr[k] / scale[to];
        variance[to] = 2 * error * error;  // of a half
      }
      precision[p] = image.samples[p] / fewest;
      const float luminous = image.luminous[p];
      depth[p] = std::isfinite(image.depth[p]) ? image.depth[p] : kNothing;
      for (std::size_t k = 0; k < 3; ++k) normal[k][p] = image.normal[3 * p + k];
      // A mirror on a wall faces as it does, and what it shows may be as bright.
      normal[1][p] += kMirror * image.mirroring[p];
      // A lamp in a ceiling is a thing of its own, and what a pixel on its rim happens to see of it is no
      // noise of the ceiling around.
      sees_luminaire[p] = luminous > 0 ? 1 : 0;
      if (luminous >= 1) normal[0][p] += kLamp;
      if (luminous > 0 && luminous < 1) normal[0][p] = kMixed * static_cast<float>(2 + number_nearby(p));
    }
  });
  find_slopes();
}

StillPlanes::StillPlanes(const StillPlanes& fine, int side)
    : width((fine.width + side - 1) / side), height((fine.height + side - 1) / side), bands(fine.bands) {
  // Of a square of one surface: how far normals lie from their mean, and depths from each other besides what
  // their slope says.
  constexpr float kTurned = 0.1F;
  constexpr float kApart = 0.01F;
  const std::size_t n = pixels();
  const auto mean_over = [&](int x, int y, const std::vector<float>& values, std::size_t plane) {
    float sum = 0;
    float count = 0;
    for (int v = y * side; v < std::min(fine.height, (y + 1) * side); ++v)
      for (int u = x * side; u < std::min(fine.width, (x + 1) * side); ++u, ++count)
        sum += values[plane * fine.pixels() + fine.at(u, v)];
    return sum / count;
  };
  const auto reduce = [&](const std::vector<float>& values, std::size_t planes) {
    std::vector<float> result(planes * n);
    tbb::parallel_for(0, height, [&](int y) {
      for (std::size_t k = 0; k < planes; ++k)
        for (int x = 0; x < width; ++x) result[k * n + at(x, y)] = mean_over(x, y, values, k);
    });
    return result;
  };
  for (std::size_t h = 0; h < 2; ++h) irradiance[h] = reduce(fine.irradiance[h], bands);
  direct = reduce(fine.direct, bands);
  if (!fine.caustic.empty()) caustic = reduce(fine.caustic, bands);
  precision = reduce(fine.precision, 1);
  depth = reduce(fine.depth, 1);
  for (std::size_t k = 0; k < 3; ++k) normal[k] = reduce(fine.normal[k], 1);
  const auto is_one = [&](int x, int y) {
    const std::size_t p = at(x, y);
    const float reach = static_cast<float>(side);
    for (int v = y * side; v < std::min(fine.height, (y + 1) * side); ++v)
      for (int u = x * side; u < std::min(fine.width, (x + 1) * side); ++u) {
        const std::size_t q = fine.at(u, v);
        float turned = 0;
        for (std::size_t k = 0; k < 3; ++k)
          turned += (fine.normal[k][q] - normal[k][p]) * (fine.normal[k][q] - normal[k][p]);
        const float allowed = kApart * depth[p] + reach * (fine.slope_x[q] + fine.slope_y[q]);
        if (turned > kTurned * kTurned || std::abs(fine.depth[q] - depth[p]) > allowed) return false;
      }
    return true;
  };
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x)
      if (!is_one(x, y)) normal[0][at(x, y)] = kMixed * static_cast<float>(2 + at(x, y));
  });
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
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t p = at(x, y);
      const auto row = static_cast<std::size_t>(width);
      slope_x[p] = slope(p, x > 0, p - 1, x + 1 < width, p + 1);
      slope_y[p] = slope(p, y > 0, p - row, y + 1 < height, p + row);
    }
  });
}

}  // namespace reemit
