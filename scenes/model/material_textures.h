#pragma once
#include <memory>
#include <optional>

#include "scenes/model/bands.h"
#include "scenes/model/texture.h"

namespace reemit {

class ColourSpectra;

/// How the colours of an image, and of vertices, become spectra in rooms of spectral bands.
struct TexelSpectra {
  std::shared_ptr<const ColourSpectra> spectra;  ///< Null: of rooms of other bands.
  Eigen::Array3f tint = Eigen::Array3f::Ones();  ///< Multiplies colours before they become spectra.
};

/// What of a material varies over a surface. The values of Material itself are then means over the images.
/// Roughness, metallic and specular shares do not vary: readers take their means (docs/textures.md).
struct MaterialTextures {
  Texture reflectance;  ///< Diffuse, of every side that has no reflectance of its own.
  /// Where the image is 1 [0,1]; size 0 = Material::reflectance is, which the colours of vertices multiply.
  Spectrum reflectance_factor;
  TexelSpectra reflectance_spectra;
  /// No point reflects more [0,1], so that nothing is gained together with the other shares; finish_scene
  /// sets it.
  Spectrum most_reflectance;
  Texture emission;
  Spectrum emission_factor;  ///< Radiance along the normal where the image is 1 [W/(m2 sr)].
  TexelSpectra emission_spectra;
  Texture opacity;
  bool opacity_is_colour = false;        ///< Opacity is the red of the image, else its opacity.
  double opacity_factor = 1;             ///< [0,1]
  std::optional<double> opacity_cutoff;  ///< Points are there from this opacity on, else gone.

  /// Light passes straight through where the surface is not there: a share of 1 - opacity.
  bool is_cut_out() const { return opacity.image != nullptr || opacity_factor < 1; }
  bool any() const { return reflectance || emission || is_cut_out(); }
};

}  // namespace reemit
