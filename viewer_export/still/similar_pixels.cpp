#include "viewer_export/still/similar_pixels.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

constexpr int kPatch = 3;          ///< Pixels to each side that are compared.
constexpr float kStrength = 0.6F;  ///< Standard errors by which pixels may differ ([RKZ12] eq. 3: k).
/// Distance at which a pixel counts no more. The kernel is (1 - d/4)^4, which is like exp(-d) but ends.
constexpr float kFarthest = 4;
constexpr float kNormalScale = 0.25F;  ///< Length of the difference of normals that counts as distance 1.
constexpr float kDepthScale = 0.02F;   ///< Relative difference of depth that does.

}  // namespace

SimilarPixels::SimilarPixels(const StillPlanes& planes, const StillImage& image, int first, int last)
    : planes_(planes),
      image_(image),
      first_(first),
      last_(last),
      size_(static_cast<std::size_t>(planes.width) * static_cast<std::size_t>(last - first)),
      layers_(image.caustic.empty() ? 2 : 3) {
  for (std::size_t h = 0; h < 2; ++h) {
    weight_[h].assign(size_, 0.0F);
    squares_[h].assign(planes.bands * size_, 0.0F);
    sum_[h].assign(layers_ * planes.bands * size_, 0.0F);
  }
}

void SimilarPixels::average() {
  for (int dy = -kWindow; dy <= kWindow; ++dy)
    for (int dx = -kWindow; dx <= kWindow; ++dx) add_offset(dx, dy);
}

void SimilarPixels::add_offset(int dx, int dy) {
  const int x0 = std::max(0, -dx);
  const int x1 = std::min(planes_.width, planes_.width - dx);
  // Rows whose patches are needed and that the picture has at both ends.
  const int y0 = std::max({0, -dy, first_ - kPatch});
  const int y1 = std::min({planes_.height, planes_.height - dy, last_ + kPatch});
  if (x0 >= x1 || y0 >= y1) return;
  if (dx == 0 && dy == 0) {
    add_own();
    return;
  }
  for (std::size_t h = 0; h < 2; ++h) {
    find_differences(h, dx, dy, {x0, y0, x1, y1});
    average_patches(h, {x0, y0, x1, y1});
  }
  for (int y = std::max(y0, first_); y < std::min(y1, last_); ++y) add_row(y, dx, dy, {x0, y0, x1, y1});
}

void SimilarPixels::add_own() {
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t p = 0; p < size_; ++p) {
      weight_[h][p] += 1;
      add_value(h, p, planes_.at(0, first_) + p, 1);
    }
}

void SimilarPixels::add_value(std::size_t h, std::size_t p, std::size_t q, float w) {
  const std::size_t n = planes_.pixels();
  const std::size_t bands = planes_.bands;
  for (std::size_t b = 0; b < bands; ++b) {
    sum_[h][b * size_ + p] += w * planes_.irradiance[h][b * n + q];
    squares_[h][b * size_ + p] += w * w * planes_.variance[b * n + q];
    const float to_irradiance = w / planes_.scale[b * n + q];
    sum_[h][(bands + b) * size_ + p] += to_irradiance * image_.direct[q * bands + b];
    if (layers_ == 3) sum_[h][(2 * bands + b) * size_ + p] += to_irradiance * image_.caustic[q * bands + b];
  }
}

void SimilarPixels::find_differences(std::size_t h, int dx, int dy, const Area& area) {
  const std::size_t n = planes_.pixels();
  differences_.assign(area.width() * static_cast<std::size_t>(area.y1 - area.y0), 0.0F);
  const float share = 1.0F / static_cast<float>(planes_.bands);
  for (std::size_t b = 0; b < planes_.bands; ++b) {
    const float* value = &planes_.irradiance[h][b * n];
    const float* variance = &planes_.variance[b * n];
    for (int y = area.y0; y < area.y1; ++y) {
      const std::size_t p = planes_.at(area.x0, y);
      const std::size_t q = planes_.at(area.x0 + dx, y + dy);
      float* out = &differences_[area.at(area.x0, y)];
      for (std::size_t i = 0; i < area.width(); ++i) {
        const float difference = value[p + i] - value[q + i];
        const float vp = variance[p + i];
        const float vq = variance[q + i];
        const float tiny = 1e-6F * value[p + i] * value[p + i] + 1e-30F;
        out[i] += share * (difference * difference - (vp + std::min(vp, vq))) /
                  (tiny + kStrength * kStrength * (vp + vq));
      }
    }
  }
}

void SimilarPixels::average_patches(std::size_t h, const Area& area) {
  rows_.resize(differences_.size());
  patches_[h].resize(differences_.size());
  const int most = static_cast<int>(area.width());
  for (int y = area.y0; y < area.y1; ++y) {
    const float* in = &differences_[area.at(area.x0, y)];
    float* out = &rows_[area.at(area.x0, y)];
    for (int i = 0; i < most; ++i) {
      const int from = std::max(0, i - kPatch);
      const int to = std::min(most, i + kPatch + 1);
      float sum = 0;
      for (int j = from; j < to; ++j) sum += in[j];
      out[i] = sum / static_cast<float>(to - from);
    }
  }
  for (int y = std::max(area.y0, first_); y < std::min(area.y1, last_); ++y) {
    const int from = std::max(area.y0, y - kPatch);
    const int to = std::min(area.y1, y + kPatch + 1);
    float* out = &patches_[h][area.at(area.x0, y)];
    std::fill(out, out + area.width(), 0.0F);
    for (int j = from; j < to; ++j) {
      const float* in = &rows_[area.at(area.x0, j)];
      for (std::size_t i = 0; i < area.width(); ++i) out[i] += in[i];
    }
    for (std::size_t i = 0; i < area.width(); ++i) out[i] /= static_cast<float>(to - from);
  }
}

float SimilarPixels::distance_of_things(std::size_t p, std::size_t q, int dx, int dy) const {
  float normals = 0;
  for (const std::vector<float>& axis : planes_.normal) {
    const float difference = axis[p] - axis[q];
    normals += difference * difference;
  }
  const float allowed =
      kDepthScale * planes_.depth[p] + 2 * (static_cast<float>(std::abs(dx)) * planes_.slope_x[p] +
                                            static_cast<float>(std::abs(dy)) * planes_.slope_y[p]);
  const float depth = (planes_.depth[p] - planes_.depth[q]) / allowed;
  return std::max(normals / (kNormalScale * kNormalScale), depth * depth);
}

void SimilarPixels::add_row(int y, int dx, int dy, const Area& area) {
  for (int x = area.x0; x < area.x1; ++x) {
    const std::size_t k = area.at(x, y);
    if (!(std::min(patches_[0][k], patches_[1][k]) < kFarthest)) continue;
    const std::size_t from = planes_.at(x, y);
    const std::size_t q = planes_.at(x + dx, y + dy);
    const float things = distance_of_things(from, q, dx, dy);
    if (!(things < kFarthest)) continue;
    const std::size_t p = from - planes_.at(0, first_);
    for (std::size_t h = 0; h < 2; ++h) {
      const float distance = std::max({0.0F, patches_[1 - h][k], things});
      if (!(distance < kFarthest)) continue;
      const float near = 1 - distance / kFarthest;
      const float w = near * near * near * near;
      weight_[h][p] += w;
      add_value(h, p, q, w);
    }
  }
}

}  // namespace reemit
