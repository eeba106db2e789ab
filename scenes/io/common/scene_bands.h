#pragma once
#include "scenes/io/common/spectral_bands.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Brings a material of an RGB room to the bands of another, `scene`: by luminance to a grey one; to a
/// spectral one by Upsampling in equal-energy white (docs/spectral.md), shares of the light together so that
/// they do not exceed 1, texels by ColourSpectra. Pre: the material has bands `from`, which are RGB or equal
/// to those of the scene. Returns the largest deviation of a colour (Upsampled).
double convert_material(Material& material, const BandSet& from, const Scene& scene);

/// Brings a grey or RGB room to spectral bands: reflectances keep their colours in the mean light of the
/// room's luminaires where that is not too far from white, else in equal-energy white; a note says which.
/// Texels, colours of vertices and pixels of the sky become ColourSpectra. A room that has these bands is
/// left as it is. Throws InputError for a room with other spectral bands. Pre: check_materials and
/// check_lights hold.
void give_bands(Scene& scene, const SpectralBands& bands);

}  // namespace reemit
