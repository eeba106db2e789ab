#include "viewer_export/still/similar_pixels.h"

#include <algorithm>
#include <cmath>

#include "viewer_export/still/pixel_rows.h"

namespace reemit {
namespace {

/// Distance at which a pixel counts no more. The kernel is (1 - d/4)^4, which is like exp(-d) but ends.
constexpr float kNotAlike = 4;
constexpr float kNormalScale = 0.25F;  ///< Length of the difference of normals that counts as distance 1.
constexpr float kDepthScale = 0.02F;   ///< Relative difference of depth that does.

}  // namespace

PixelGuide PixelGuide::of(const StillPlanes& planes) {
  constexpr int kPatch = 3;
  constexpr float kStrength = 0.6F;
  return {{planes.irradiance[0].data(), planes.irradiance[1].data()},
          planes.variance.data(),
          kPatch,
          kStrength,
          1};
}

SimilarPixels::SimilarPixels(const StillPlanes& planes, const PixelGuide& guide, Extent extent, int first,
                             int last)
    : planes_(planes),
      guide_(guide),
      window_(extent == Extent::kWide ? 8 : 4),
      first_(first),
      last_(last),
      size_(static_cast<std::size_t>(planes.width) * static_cast<std::size_t>(last - first)),
      layers_(extent == Extent::kNarrow ? 1
              : planes.caustic.empty()  ? 2
                                        : 3) {
  for (std::size_t h = 0; h < 2; ++h) {
    weight_[h].assign(size_, 0.0F);
    squares_[h].assign(planes.bands * size_, 0.0F);
    sum_[h].assign(layers_ * planes.bands * size_, 0.0F);
  }
}

void SimilarPixels::average() {
  for (int dy = -window_; dy <= window_; ++dy)
    for (int dx = -window_; dx <= window_; ++dx) add_offset(dx, dy);
}

void SimilarPixels::add_offset(int dx, int dy) {
  const int x0 = std::max(0, -dx);
  const int x1 = std::min(planes_.width, planes_.width - dx);
  // Rows whose patches are needed and that the picture has at both ends.
  const int y0 = std::max({0, -dy, first_ - guide_.patch});
  const int y1 = std::min({planes_.height, planes_.height - dy, last_ + guide_.patch});
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
  const float* own = &planes_.precision[planes_.at(0, first_)];
  row_weight_.assign(own, own + size_);
  for (std::size_t h = 0; h < 2; ++h) add_values(h, 0, planes_.at(0, first_), size_);
}

void SimilarPixels::add_values(std::size_t h, std::size_t p, std::size_t q, std::size_t count) {
  const float* w = row_weight_.data();
  const auto add_plane = [&](std::size_t plane, const float* values) {
    pixel_rows::add_weighted(&sum_[h][plane * size_ + p], w, values, count);
  };
  float* weight = &weight_[h][p];
  for (std::size_t i = 0; i < count; ++i) weight[i] += w[i];
  const std::size_t n = planes_.pixels();
  const std::size_t bands = planes_.bands;
  for (std::size_t b = 0; b < bands; ++b) {
    add_plane(b, &planes_.irradiance[h][b * n + q]);
    if (layers_ > 1) add_plane(bands + b, &planes_.direct[b * n + q]);
    if (layers_ == 3) add_plane(2 * bands + b, &planes_.caustic[b * n + q]);
    pixel_rows::add_variances(&squares_[h][b * size_ + p], w, &planes_.variance[b * n + q], count);
  }
}

void SimilarPixels::find_differences(std::size_t h, int dx, int dy, const Area& area) {
  const std::size_t n = planes_.pixels();
  differences_.assign(area.width() * static_cast<std::size_t>(area.y1 - area.y0), 0.0F);
  const float share = 1.0F / static_cast<float>(planes_.bands);
  for (std::size_t b = 0; b < planes_.bands; ++b) {
    const float* value = guide_.value[h] + b * n;
    const float* variance = guide_.variance + b * n;
    for (int y = area.y0; y < area.y1; ++y) {
      const std::size_t p = planes_.at(area.x0, y);
      const std::size_t q = planes_.at(area.x0 + dx, y + dy);
      pixel_rows::add_differences(&differences_[area.at(area.x0, y)], {value + p, variance + p},
                                  {value + q, variance + q}, {share, guide_.strength, guide_.noise},
                                  area.width());
    }
  }
}

void SimilarPixels::average_patches(std::size_t h, const Area& area) {
  rows_.resize(differences_.size());
  patches_[h].resize(differences_.size());
  for (int y = area.y0; y < area.y1; ++y)
    pixel_rows::average_along(&rows_[area.at(area.x0, y)], &differences_[area.at(area.x0, y)], guide_.patch,
                              area.width());
  for (int y = std::max(area.y0, first_); y < std::min(area.y1, last_); ++y) {
    const int from = std::max(area.y0, y - guide_.patch);
    const int to = std::min(area.y1, y + guide_.patch + 1);
    pixel_rows::average_across(&patches_[h][area.at(area.x0, y)], &rows_[area.at(area.x0, from)],
                               static_cast<std::size_t>(to - from), area.width(), area.width());
  }
}

void SimilarPixels::add_row(int y, int dx, int dy, const Area& area) {
  const std::size_t from = planes_.at(area.x0, y);
  const std::size_t q = planes_.at(area.x0 + dx, y + dy);
  const std::size_t patch = area.at(area.x0, y);
  row_things_.resize(area.width());
  row_weight_.resize(area.width());
  const auto things_at = [&](std::size_t first) {
    return pixel_rows::Things{
        {&planes_.normal[0][first], &planes_.normal[1][first], &planes_.normal[2][first]},
        &planes_.depth[first],
        &planes_.slope_x[first],
        &planes_.slope_y[first]};
  };
  pixel_rows::find_distances(row_things_.data(), things_at(from), things_at(q),
                             {.normals = kNormalScale,
                              .depth = kDepthScale,
                              .columns = static_cast<float>(std::abs(dx)),
                              .rows = static_cast<float>(std::abs(dy))},
                             area.width());
  const bool any = std::any_of(row_things_.begin(), row_things_.end(), [](float d) { return d < kNotAlike; });
  if (!any) return;
  for (std::size_t h = 0; h < 2; ++h) {
    pixel_rows::weigh(row_weight_.data(), &patches_[1 - h][patch], row_things_.data(), kNotAlike,
                      &planes_.precision[q], area.width());
    add_values(h, from - planes_.at(0, first_), q, area.width());
  }
}

}  // namespace reemit
