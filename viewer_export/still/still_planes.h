#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "viewer_export/still/still_image.h"

namespace reemit {

/// A still taken apart for comparing pixels: planes of one value per pixel, by band where so said
/// (index band * pixels + pixel).
struct StillPlanes {
  /// Pre: the still has standard errors, and halves of its layout.
  StillPlanes(const StillImage& image, const StillHalves& halves);

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  int width;
  int height;
  std::size_t bands;
  /// Radiance over `scale` of each half, by band [W/(m2 sr)]: where diffuse light is seen, irradiance over
  /// pi.
  std::array<std::vector<float>, 2> irradiance;
  std::vector<float> direct;     ///< Likewise of the layers of both halves, by band.
  std::vector<float> caustic;    ///< Empty where there is none.
  std::vector<float> scale;      ///< By band: reflectance, where it is not next to 0.
  std::vector<float> variance;   ///< By band, of one half's irradiance.
  std::vector<float> precision;  ///< Samples over the fewest that a pixel has.
  std::vector<float> depth;      ///< [m], finite.
  std::array<std::vector<float>, 3> normal;
  std::vector<float> slope_x, slope_y;  ///< Of depth per pixel [m]: of both sides the smaller.

 private:
  void find_slopes();
};

}  // namespace reemit
