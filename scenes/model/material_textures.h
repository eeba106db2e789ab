#pragma once
#include <optional>

#include "scenes/model/bands.h"
#include "scenes/model/texture.h"

namespace reemit {

/// What of a material varies over a surface. The values of Material itself are then means over the images.
/// Roughness, metallic and specular shares do not vary: readers take their means (docs/textures.md).
struct MaterialTextures {
  Texture reflectance;          ///< Diffuse, of every side that has no reflectance of its own.
  Spectrum reflectance_factor;  ///< Where the image is 1 [0,1].
  /// No point reflects more [0,1], so that nothing is gained together with the other shares; finish_scene
  /// sets it.
  Spectrum most_reflectance;
  Texture emission;
  Spectrum emission_factor;  ///< Radiance along the normal where the image is 1 [W/(m2 sr)].
  Texture opacity;
  bool opacity_is_colour = false;        ///< Opacity is the red of the image, else its opacity.
  double opacity_factor = 1;             ///< [0,1]
  std::optional<double> opacity_cutoff;  ///< Points are there from this opacity on, else gone.

  /// Light passes straight through where the surface is not there: a share of 1 - opacity.
  bool is_cut_out() const { return opacity.image != nullptr || opacity_factor < 1; }
  bool any() const { return reflectance || emission || is_cut_out(); }
};

}  // namespace reemit
