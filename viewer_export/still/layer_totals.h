#pragma once
#include <array>
#include <vector>

#include "viewer_export/still/still_planes.h"

namespace reemit {

/// The light of a whole picture but for pixels that see luminaires, which would outshine all else, layer by
/// layer. Means over pixels that look alike lose some of it where
/// noise is skewed: few pixels are like one that chance made bright, and it counts in few means. Photons make
/// such noise (a density that k of them tell), and so do paths.
class LayerTotals {
 public:
  explicit LayerTotals(const StillPlanes& planes);

  /// Scales each layer of a picture of the same size and bands so that it has these totals: all pixels alike,
  /// so that no edge moves. Layers that are off by more than kMost are left.
  void give_back_to(StillPlanes& planes) const;

 private:
  static constexpr double kMost = 0.25;
  enum Layer : std::size_t { kDirect, kCaustic, kRest, kLayers };

  template <class Use>
  static void for_each_pixel(const StillPlanes& planes, std::size_t band, const Use& use);
  /// Of a pixel, by layer; `at` as the index of StillPlanes::irradiance.
  static std::array<double, kLayers> light_at(const StillPlanes& planes, std::size_t at);

  std::vector<std::array<double, kLayers>> total_;  // by band, radiance summed over pixels
};

}  // namespace reemit
