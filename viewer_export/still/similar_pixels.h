#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>

#include "scenes/model/stop_token.h"
#include "viewer_export/still/still_planes.h"

namespace reemit {

/// What tells how alike pixels are: values of each half in the layout of StillPlanes::irradiance.
struct PixelGuide {
  std::array<const float*, 2> value;
  const float* variance;  ///< Of the noise in one half's.
  int patch;              ///< Pixels to each side that are compared along with a pixel.
  float strength, noise;  ///< As of pixel_rows::DifferenceScales.

  /// The pixels themselves.
  static PixelGuide of(const StillPlanes& planes);
};

/// Means of the pixels of some rows of a still over the pixels around them that are the same within their
/// noise: non-local means with two buffers ([RKZ12] sec. 4), bounded by normal and depth. Light that slopes
/// evenly is no difference: two pixels opposite each other also count if their mean is the same, and then
/// both alike, so that slopes cancel. What is found of a pixel does not depend on which rows it is looked at
/// with.
class SimilarPixels {
 public:
  /// What is averaged.
  enum class Extent {
    kWide,   ///< All layers over the 225 pixels of a circle.
    kNarrow  ///< Irradiance alone over 81 of them.
  };

  /// Rows first .. last-1. The planes and what guides must outlive it.
  SimilarPixels(const StillPlanes& planes, const PixelGuide& guide, Extent extent, int first, int last);

  /// Before anything is read.
  void average();

  // In what follows p counts the pixels from the first row on.

  /// Of the half `h`, averaged by what the other half chose: irradiance (layer 0), its direct (1) and
  /// caustic part (2), as StillPlanes::irradiance.
  float mean(std::size_t h, std::size_t layer, std::size_t band, std::size_t p) const {
    return sum_[h][(layer * planes_.bands + band) * size_ + p] / weight_[h][p];
  }
  /// Of layers that the halves do not tell apart.
  float mean_of_both(std::size_t layer, std::size_t band, std::size_t p) const {
    return 0.5F * (mean(0, layer, band, p) + mean(1, layer, band, p));
  }
  /// Square of the standard error of the mean of both halves, of noise that pixels do not share.
  float variance(std::size_t band, std::size_t p) const {
    float sum = 0;
    for (std::size_t h = 0; h < 2; ++h)
      sum += squares_[h][band * size_ + p] / (weight_[h][p] * weight_[h][p]);
    return 0.25F * sum;
  }
  /// Share of a pixel's own value in its mean.
  float own_share(std::size_t p) const {
    const float own = planes_.precision[planes_.at(0, first_) + p];
    return 0.5F * (own / weight_[0][p] + own / weight_[1][p]);
  }

 private:
  /// Pixels of the picture.
  struct Area {
    int x0, y0, x1, y1;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    std::size_t width() const { return static_cast<std::size_t>(x1 - x0); }
    std::size_t height() const { return static_cast<std::size_t>(y1 - y0); }
    std::size_t at(int x, int y) const {
      return static_cast<std::size_t>(y - y0) * width() + static_cast<std::size_t>(x - x0);
    }
  };
  /// Neighbours at an offset, of the pixels x0 .. x1-1 of a row.
  struct Side {
    int dx, dy, x0, x1;
    std::size_t width() const { return static_cast<std::size_t>(x1 - x0); }
    std::size_t at(int x) const { return static_cast<std::size_t>(x - x0); }
  };

  void add_own();
  /// Adds to every pixel its neighbours at this offset and the opposite one, as far as they are the same.
  void add_opposite(int dx, int dy);
  /// Pre: the patches are found.
  void add_row(int y, int dx, int dy);
  /// How far what the pixels of a row see is from what those on this side do; false if all too far.
  bool find_things(std::vector<float>& distances, int y, const Side& side);
  /// What pairs of a row have in common: things as far away as the farther one's, and as many samples as the
  /// one with fewer, since both must count alike.
  void join(int y, const std::array<Side, 2>& sides);
  /// `count` pixels of the picture from q on to the sums from p on, with the weights of row_weight_.
  void add_values(std::size_t h, std::size_t p, std::size_t q, std::size_t count);

  /// Squared differences over what noise explains, mean over bands ([RKZ12] eq. 3), means over patches: of
  /// pixels from their neighbours at the offset, or from the means of those and the opposite ones.
  void compare(std::size_t h, int dx, int dy);
  void compare_pairs(std::size_t h, int dx, int dy);
  /// For each band and row: add_row(sums of the row's pixels, pixels_at), where pixels_at(dx, dy) are those
  /// at an offset from them.
  template <class AddRow>
  void compare_rows(std::size_t h, const Area& area, AddRow&& add_row);
  /// Means over patches, rows `from` .. last-1: along, then across. Added up anew for every pixel, so that
  /// they do not depend on where a stripe begins.
  void average_patches(std::vector<float>& patches, const Area& area, int from);

  const StillPlanes& planes_;
  PixelGuide guide_;
  int reach_;          // pixels to each side
  int reach_squared_;  // of the circle that offsets lie in
  int first_, last_;
  std::size_t size_;
  std::size_t layers_;
  std::array<std::vector<float>, 2> weight_, squares_, sum_;
  std::vector<float> differences_, rows_;
  Area neighbours_{}, pairs_{};  // that are compared
  std::array<std::vector<float>, 2> patches_, pair_patches_;
  std::array<std::vector<float>, 2> row_things_;
  std::vector<float> row_weight_, pair_things_, pair_precision_, pair_weight_;
};

constexpr int kSmoothedRows = 16;  ///< Rows of pixels that are averaged in one go.

/// Hands the means of all pixels, `rows` rows after the other, to take(means, first row, last row) on several
/// threads. Ends early when `stop` is requested.
template <class Take>
void for_similar_pixels(const StillPlanes& planes, const PixelGuide& guide, SimilarPixels::Extent extent,
                        int rows, const StopToken& stop, Take&& take) {
  tbb::parallel_for(0, (planes.height + rows - 1) / rows, [&](int s) {
    if (stop.requested()) return;
    const int first = s * rows;
    const int last = std::min(planes.height, first + rows);
    SimilarPixels means(planes, guide, extent, first, last);
    means.average();
    take(means, first, last);
  });
}

}  // namespace reemit
