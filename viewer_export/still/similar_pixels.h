#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "viewer_export/still/still_planes.h"

namespace reemit {

/// What tells how alike pixels are: values of each half in the layout of StillPlanes::irradiance.
struct PixelGuide {
  std::array<const float*, 2> value;
  const float* variance;  ///< Of the noise in one half's.
  int patch;              ///< Pixels to each side that are compared.
  float strength, noise;  ///< As of pixel_rows::DifferenceScales.

  /// The pixels themselves.
  static PixelGuide of(const StillPlanes& planes);
};

/// Means of the pixels of some rows of a still over the pixels around them that are the same within their
/// noise: non-local means with two buffers ([RKZ12] sec. 4), bounded by normal and depth. What is found of a
/// pixel does not depend on which rows it is looked at with.
class SimilarPixels {
 public:
  /// What is averaged.
  enum class Extent {
    kWide,   ///< All layers over 17 x 17 pixels.
    kNarrow  ///< Irradiance alone over 9 x 9 pixels.
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
  /// Pixels that have a neighbour at the offset looked at, in rows whose patches are needed.
  struct Area {
    int x0, y0, x1, y1;
    std::size_t width() const { return static_cast<std::size_t>(x1 - x0); }
    std::size_t at(int x, int y) const {
      return static_cast<std::size_t>(y - y0) * width() + static_cast<std::size_t>(x - x0);
    }
  };

  /// Adds to every pixel its neighbour at this offset, as far as both are the same.
  void add_offset(int dx, int dy);
  void add_own();
  /// `count` pixels of the picture from q on to the sums from p on, with the weights of row_weight_.
  void add_values(std::size_t h, std::size_t p, std::size_t q, std::size_t count);

  /// Squared difference of pixels over what noise explains, mean over bands ([RKZ12] eq. 3).
  void find_differences(std::size_t h, int dx, int dy, const Area& area);

  /// Means of the differences over patches: rows, then columns. Added up anew for every pixel, so that they
  /// do not depend on where a stripe begins.
  void average_patches(std::size_t h, const Area& area);

  void add_row(int y, int dx, int dy, const Area& area);

  const StillPlanes& planes_;
  PixelGuide guide_;
  int window_;  // pixels to each side
  int first_, last_;
  std::size_t size_;
  std::size_t layers_;
  std::array<std::vector<float>, 2> weight_, squares_, sum_;
  std::vector<float> differences_, rows_, row_things_, row_weight_;
  std::array<std::vector<float>, 2> patches_;
};

}  // namespace reemit
