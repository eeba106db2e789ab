#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewer_export/still/still_image.h"

namespace reemit {

/// A still taken apart for comparing pixels: planes of one value per pixel, by band where so said
/// (index band * pixels + pixel).
struct StillPlanes {
  /// Pre: the still has standard errors of radiance and albedo, and halves of its layout.
  StillPlanes(const StillImage& image, const StillHalves& halves);
  /// Means over squares of `side` x `side` pixels, those at the right and lower rim smaller. `variance` is
  /// left empty: noise that pixels share does not fall as that of theirs. Squares that hold more than one
  /// surface get a normal that none other is like (holds_one()).
  StillPlanes(const StillPlanes& fine, int side);

  /// Of squares: whether pixel p is a mean over one surface.
  bool holds_one(std::size_t p) const { return normal[0][p] < kMixed; }

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
  std::vector<std::uint8_t> sees_luminaire;  ///< Whether any of its samples does; of squares empty.
  std::vector<float> slope_x, slope_y;       ///< Of depth per pixel [m]: of both sides the smaller.

 private:
  static constexpr float kMixed = 1e3F;

  void find_slopes();
};

}  // namespace reemit
