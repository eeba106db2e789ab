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

SimilarPixels::SimilarPixels(const StillPlanes& planes, int first, int last)
    : planes_(planes),
      first_(first),
      last_(last),
      size_(static_cast<std::size_t>(planes.width) * static_cast<std::size_t>(last - first)),
      layers_(planes.caustic.empty() ? 2 : 3) {
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
  row_weight_.assign(size_, 1.0F);
  for (std::size_t h = 0; h < 2; ++h) add_values(h, 0, planes_.at(0, first_), size_);
}

void SimilarPixels::add_values(std::size_t h, std::size_t p, std::size_t q, std::size_t count) {
  const float* w = row_weight_.data();
  const auto add_plane = [&](std::vector<float>& sums, std::size_t plane, const float* values) {
    float* sum = &sums[plane * size_ + p];
    for (std::size_t i = 0; i < count; ++i) sum[i] += w[i] * values[i];
  };
  float* weight = &weight_[h][p];
  for (std::size_t i = 0; i < count; ++i) weight[i] += w[i];
  const std::size_t n = planes_.pixels();
  const std::size_t bands = planes_.bands;
  for (std::size_t b = 0; b < bands; ++b) {
    add_plane(sum_[h], b, &planes_.irradiance[h][b * n + q]);
    add_plane(sum_[h], bands + b, &planes_.direct[b * n + q]);
    if (layers_ == 3) add_plane(sum_[h], 2 * bands + b, &planes_.caustic[b * n + q]);
    const float* variance = &planes_.variance[b * n + q];
    float* squares = &squares_[h][b * size_ + p];
    for (std::size_t i = 0; i < count; ++i) squares[i] += w[i] * w[i] * variance[i];
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
  const std::size_t from = planes_.at(area.x0, y);
  const std::size_t q = planes_.at(area.x0 + dx, y + dy);
  const std::size_t patch = area.at(area.x0, y);
  row_things_.resize(area.width());
  row_weight_.resize(area.width());
  bool any = false;
  for (std::size_t i = 0; i < area.width(); ++i) {
    const bool near = std::min(patches_[0][patch + i], patches_[1][patch + i]) < kFarthest;
    row_things_[i] = near ? distance_of_things(from + i, q + i, dx, dy) : kFarthest;
    any = any || row_things_[i] < kFarthest;
  }
  if (!any) return;
  for (std::size_t h = 0; h < 2; ++h) {
    const float* other = &patches_[1 - h][patch];
    for (std::size_t i = 0; i < area.width(); ++i) {
      const float distance = std::min(kFarthest, std::max({0.0F, other[i], row_things_[i]}));
      const float near = 1 - distance / kFarthest;
      row_weight_[i] = near * near * near * near;
    }
    add_values(h, from - planes_.at(0, first_), q, area.width());
  }
}

}  // namespace reemit
