#include "viewer_export/still/coarse_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <tbb/parallel_for.h>

#include "viewer_export/still/similar_pixels.h"

namespace reemit {
namespace {

/// Pixels to a side of squares, one after the other: each takes out blotches of about three squares.
constexpr std::array<int, 3> kSides{4, 8, 16};
constexpr int kAround = 3;  ///< Squares to each side whose noise is taken to be alike.
/// Light that differs by more than this share within a square is no noise, but the edge of something.
constexpr float kContrast = 0.5F;
/// Of the value of a pixel.
constexpr float kMostChange = 0.3F;
constexpr int kRowsTogether = 8;  ///< Rows of squares that are smoothed in one go.

/// Whether the surface of a pixel or square goes on to another, at most so many of its steps away.
bool goes_on(const StillPlanes& from, std::size_t p, const StillPlanes& to, std::size_t q, float steps) {
  constexpr float kNormals = 0.25F;  // length of the difference
  constexpr float kDepth = 0.02F;    // relative, besides what the slope says
  float turned = 0;
  for (std::size_t k = 0; k < 3; ++k)
    turned += (from.normal[k][p] - to.normal[k][q]) * (from.normal[k][p] - to.normal[k][q]);
  const float allowed = kDepth * from.depth[p] + steps * (from.slope_x[p] + from.slope_y[p]);
  return turned < kNormals * kNormals && std::abs(from.depth[p] - to.depth[q]) < allowed;
}

/// Variance of one half of each square, from how far the halves of those around it are apart.
void find_variances(StillPlanes& squares) {
  squares.variance.assign(squares.bands * squares.pixels(), 0.0F);
  const std::size_t n = squares.pixels();
  tbb::parallel_for(0, squares.height, [&](int y) {
    for (int x = 0; x < squares.width; ++x) {
      const std::size_t p = squares.at(x, y);
      std::vector<std::size_t> around{p};
      for (int v = std::max(0, y - kAround); v <= std::min(squares.height - 1, y + kAround); ++v)
        for (int u = std::max(0, x - kAround); u <= std::min(squares.width - 1, x + kAround); ++u)
          if (const std::size_t q = squares.at(u, v); q != p && goes_on(squares, p, squares, q, 2 * kAround))
            around.push_back(q);
      for (std::size_t b = 0; b < squares.bands; ++b) {
        float sum = 0;
        for (const std::size_t q : around) {
          const float apart = squares.irradiance[0][b * n + q] - squares.irradiance[1][b * n + q];
          sum += 0.5F * apart * apart;
        }
        squares.variance[b * n + p] = sum / static_cast<float>(around.size());
      }
    }
  });
}

/// Values by band and pixel, as those of StillPlanes.
struct Changes {
  std::array<std::vector<float>, 2> irradiance;
  std::vector<float> direct, caustic;
};

/// What smoothing changes of squares.
Changes changes_of(const StillPlanes& squares, const StopToken& stop) {
  const std::size_t n = squares.pixels();
  Changes result{squares.irradiance, squares.direct, squares.caustic};
  const auto take = [&](const SimilarPixels& means, int first, int last) {
    const std::size_t start = squares.at(0, first);
    for (std::size_t p = 0; p < squares.at(0, last) - start; ++p)
      for (std::size_t b = 0; b < squares.bands; ++b) {
        const std::size_t at = b * n + start + p;
        for (std::size_t h = 0; h < 2; ++h)
          result.irradiance[h][at] = means.mean(h, 0, b, p) - squares.irradiance[h][at];
        result.direct[at] = means.mean_of_both(1, b, p) - squares.direct[at];
        result.caustic[at] = means.mean_of_both(2, b, p) - squares.caustic[at];
      }
  };
  for_similar_pixels(squares, PixelGuide::of(squares), SimilarPixels::Extent::kWide, kRowsTogether, stop,
                     take);
  return result;
}

/// By square: 1 where light is about even on it, in all bands, else 0.
std::vector<std::uint8_t> even_squares(const StillPlanes& pixels, const StillPlanes& squares, int side) {
  std::vector<std::uint8_t> even(squares.pixels(), 1);
  const std::size_t n = pixels.pixels();
  tbb::parallel_for(0, squares.height, [&](int y) {
    for (int x = 0; x < squares.width; ++x)
      for (std::size_t b = 0; b < pixels.bands; ++b) {
        float least = std::numeric_limits<float>::infinity();
        float most = 0;
        for (int v = y * side; v < std::min(pixels.height, (y + 1) * side); ++v)
          for (int u = x * side; u < std::min(pixels.width, (x + 1) * side); ++u) {
            const std::size_t p = b * n + pixels.at(u, v);
            const float value = 0.5F * (pixels.irradiance[0][p] + pixels.irradiance[1][p]);
            least = std::min(least, value);
            most = std::max(most, value);
          }
        if (most - least > kContrast * most) even[squares.at(x, y)] = 0;
      }
  });
  return even;
}

/// The squares around a pixel that lie on its surface, with their shares in it.
struct Neighbourhood {
  std::array<std::size_t, 4> square{};
  std::array<float, 4> share{};

  Neighbourhood(const StillPlanes& pixels, const StillPlanes& squares, const std::vector<std::uint8_t>& even,
                int side, int x, int y) {
    const std::size_t p = pixels.at(x, y);
    const auto place = [&](int i) {
      return (static_cast<float>(i) + 0.5F) / static_cast<float>(side) - 0.5F;
    };
    const float fx = std::floor(place(x));
    const float fy = std::floor(place(y));
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const int u = std::clamp(static_cast<int>(fx) + static_cast<int>(k & 1), 0, squares.width - 1);
      const int v = std::clamp(static_cast<int>(fy) + static_cast<int>(k >> 1), 0, squares.height - 1);
      square[k] = squares.at(u, v);
      const float along_x = (k & 1) != 0 ? place(x) - fx : 1 - (place(x) - fx);
      const float along_y = (k >> 1) != 0 ? place(y) - fy : 1 - (place(y) - fy);
      if (even[square[k]] != 0 && squares.holds_one(square[k]) &&
          goes_on(pixels, p, squares, square[k], static_cast<float>(2 * side)))
        share[k] = along_x * along_y;
      sum += share[k];
    }
    constexpr float kLeast = 1e-3F;
    for (float& s : share) s = sum > kLeast ? s / sum : 0;
  }

  float mean(const float* values) const {
    float sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (share[k] > 0) sum += share[k] * values[square[k]];
    return sum;
  }
};

/// The part of smooth_coarsely for squares of one size.
void smooth_by_squares(int side, const StopToken& stop, StillPlanes& pixels) {
  StillPlanes squares(pixels, side);
  find_variances(squares);
  const Changes changes = changes_of(squares, stop);
  if (stop.requested()) return;
  const std::vector<std::uint8_t> even = even_squares(pixels, squares, side);
  const std::size_t n = pixels.pixels();
  tbb::parallel_for(0, pixels.height, [&](int y) {
    for (int x = 0; x < pixels.width; ++x) {
      const Neighbourhood around(pixels, squares, even, side, x, y);
      const std::size_t p = pixels.at(x, y);
      const auto change = [&](std::vector<float>& values, const std::vector<float>& by, std::size_t b) {
        float& value = values[b * n + p];
        const float most = kMostChange * value;
        value += std::clamp(around.mean(&by[b * squares.pixels()]), -most, most);
      };
      for (std::size_t b = 0; b < pixels.bands; ++b) {
        for (std::size_t h = 0; h < 2; ++h) change(pixels.irradiance[h], changes.irradiance[h], b);
        change(pixels.direct, changes.direct, b);
        change(pixels.caustic, changes.caustic, b);
      }
    }
  });
}

}  // namespace

void smooth_coarsely(StillPlanes& smoothed, const StopToken& stop) {
  for (const int side : kSides) smooth_by_squares(side, stop, smoothed);
}

}  // namespace reemit
