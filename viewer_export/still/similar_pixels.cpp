#include "viewer_export/still/similar_pixels.h"

#include <algorithm>
#include <cstdlib>

#include "viewer_export/still/pixel_rows.h"

namespace reemit {
namespace {

/// Distance at which a pixel counts no more. The kernel is (1 - d/4)^4, which is like exp(-d) but ends.
constexpr float kNotAlike = 4;
constexpr float kNormalScale = 0.25F;  ///< Length of the difference of normals that counts as distance 1.
constexpr float kDepthScale = 0.02F;   ///< Relative difference of depth that does.

/// Light that curves is off to the same side on all pairs, so that less is allowed for.
constexpr float kPairStrength = 0.4F;

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
      reach_(extent == Extent::kWide ? 8 : 5),
      reach_squared_(extent == Extent::kWide ? 72 : 25),
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
  add_own();
  for (int dy = 0; dy <= reach_; ++dy)
    for (int dx = dy == 0 ? 1 : -reach_; dx <= reach_; ++dx)
      if (dx * dx + dy * dy <= reach_squared_) add_opposite(dx, dy);
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

void SimilarPixels::add_opposite(int dx, int dy) {
  const int width = planes_.width;
  const int height = planes_.height;
  // Neighbours on the opposite side compare as these do from their end.
  neighbours_ = {std::max(0, -dx), std::max(0, first_ - guide_.patch - dy), std::min(width, width - dx),
                 std::min(height - dy, last_ + guide_.patch)};
  pairs_ = {std::abs(dx), std::max(dy, first_ - guide_.patch), width - std::abs(dx), neighbours_.y1};
  if (neighbours_.empty()) return;
  for (std::size_t h = 0; h < 2; ++h) {
    compare(h, dx, dy);
    if (!pairs_.empty()) compare_pairs(h, dx, dy);
  }
  for (int y = first_; y < last_; ++y) add_row(y, dx, dy);
}

template <class AddRow>
void SimilarPixels::compare_rows(std::size_t h, const Area& area, AddRow&& add_row) {
  differences_.assign(area.width() * area.height(), 0.0F);
  for (std::size_t b = 0; b < planes_.bands; ++b)
    for (int y = area.y0; y < area.y1; ++y)
      add_row(&differences_[area.at(area.x0, y)], [&](int dx, int dy) {
        const std::size_t at = b * planes_.pixels() + planes_.at(area.x0 + dx, y + dy);
        return pixel_rows::Pixels{guide_.value[h] + at, guide_.variance + at};
      });
}

void SimilarPixels::compare(std::size_t h, int dx, int dy) {
  const pixel_rows::DifferenceScales scales{1.0F / static_cast<float>(planes_.bands), guide_.strength,
                                            guide_.noise};
  compare_rows(h, neighbours_, [&](float* sum, auto&& pixels_at) {
    pixel_rows::add_differences(sum, pixels_at(0, 0), pixels_at(dx, dy), scales, neighbours_.width());
  });
  average_patches(patches_[h], neighbours_, first_ - dy);
}

void SimilarPixels::compare_pairs(std::size_t h, int dx, int dy) {
  const pixel_rows::DifferenceScales scales{1.0F / static_cast<float>(planes_.bands),
                                            kPairStrength * guide_.strength, guide_.noise};
  compare_rows(h, pairs_, [&](float* sum, auto&& pixels_at) {
    pixel_rows::add_pair_differences(sum, pixels_at(0, 0), pixels_at(dx, dy), pixels_at(-dx, -dy), scales,
                                     pairs_.width());
  });
  average_patches(pair_patches_[h], pairs_, first_);
}

void SimilarPixels::average_patches(std::vector<float>& patches, const Area& area, int from) {
  rows_.resize(differences_.size());
  patches.resize(differences_.size());
  for (int y = area.y0; y < area.y1; ++y)
    pixel_rows::average_along(&rows_[area.at(area.x0, y)], &differences_[area.at(area.x0, y)], guide_.patch,
                              area.width());
  for (int y = std::max(area.y0, from); y < std::min(area.y1, last_); ++y) {
    const int top = std::max(area.y0, y - guide_.patch);
    const int bottom = std::min(area.y1, y + guide_.patch + 1);
    pixel_rows::average_across(&patches[area.at(area.x0, y)], &rows_[area.at(area.x0, top)],
                               static_cast<std::size_t>(bottom - top), area.width(), area.width());
  }
}

bool SimilarPixels::find_things(std::vector<float>& distances, int y, const Side& side) {
  if (side.x0 >= side.x1 || y + side.dy < 0 || y + side.dy >= planes_.height) return false;
  const auto things_from = [&](int u, int v) {
    const std::size_t first = planes_.at(u, v);
    return pixel_rows::Things{
        {&planes_.normal[0][first], &planes_.normal[1][first], &planes_.normal[2][first]},
        &planes_.depth[first],
        &planes_.slope_x[first],
        &planes_.slope_y[first]};
  };
  distances.resize(side.width());
  pixel_rows::find_distances(distances.data(), things_from(side.x0, y),
                             things_from(side.x0 + side.dx, y + side.dy),
                             {.normals = kNormalScale,
                              .depth = kDepthScale,
                              .columns = static_cast<float>(std::abs(side.dx)),
                              .rows = static_cast<float>(std::abs(side.dy))},
                             side.width());
  return std::any_of(distances.begin(), distances.end(), [](float d) { return d < kNotAlike; });
}

void SimilarPixels::join(int y, const std::array<Side, 2>& sides) {
  const std::size_t count = pairs_.width();
  const auto copy = [count](std::vector<float>& to, const float* from) { to.assign(from, from + count); };
  const auto precision_at = [&](const Side& side) {
    return &planes_.precision[planes_.at(pairs_.x0 + side.dx, y + side.dy)];
  };
  copy(pair_things_, &row_things_[0][sides[0].at(pairs_.x0)]);
  pixel_rows::raise(pair_things_.data(), &row_things_[1][sides[1].at(pairs_.x0)], count);
  copy(pair_precision_, precision_at(sides[0]));
  pixel_rows::lower(pair_precision_.data(), precision_at(sides[1]), count);
  pair_weight_.resize(count);
}

void SimilarPixels::add_row(int y, int dx, int dy) {
  const int width = planes_.width;
  const std::array<Side, 2> sides{Side{dx, dy, std::max(0, -dx), std::min(width, width - dx)},
                                  Side{-dx, -dy, std::max(0, dx), std::min(width, width + dx)}};
  std::array<bool, 2> any{};
  for (std::size_t s = 0; s < 2; ++s) any[s] = find_things(row_things_[s], y, sides[s]);
  const bool pairs = any[0] && any[1] && !pairs_.empty();
  if (pairs) join(y, sides);
  for (std::size_t h = 0; h < 2; ++h) {
    if (pairs)
      pixel_rows::weigh(pair_weight_.data(), &pair_patches_[1 - h][pairs_.at(pairs_.x0, y)],
                        pair_things_.data(), kNotAlike, pair_precision_.data(), pairs_.width());
    for (std::size_t s = 0; s < 2; ++s) {
      if (!any[s]) continue;
      const Side& side = sides[s];
      const std::size_t q = planes_.at(side.x0 + side.dx, y + side.dy);
      const std::size_t patch =
          s == 0 ? neighbours_.at(side.x0, y) : neighbours_.at(side.x0 + side.dx, y + side.dy);
      row_weight_.resize(side.width());
      pixel_rows::weigh(row_weight_.data(), &patches_[1 - h][patch], row_things_[s].data(), kNotAlike,
                        &planes_.precision[q], side.width());
      if (pairs) pixel_rows::raise(&row_weight_[side.at(pairs_.x0)], pair_weight_.data(), pairs_.width());
      add_values(h, planes_.at(side.x0, y) - planes_.at(0, first_), q, side.width());
    }
  }
}

}  // namespace reemit
