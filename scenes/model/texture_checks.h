#pragma once
#include <memory>

#include "scenes/model/scene.h"

namespace reemit {

/// Whether a texture or the colours of vertices are other than grey.
bool has_coloured_textures(const Scene& scene);

/// Checks what finish_scene says of textures and their coordinates: throws InputError at coordinates that are
/// not finite or out of range; warns of faces whose material has textures but that have no coordinates. Sets
/// MaterialTextures::most_reflectance, and in rooms of spectral bands the spectra for colours of vertices.
/// After check_materials.
void check_textures(Scene& scene);

/// What the materials of a room with spectral bands of its own share: spectra of colours in equal-energy
/// white. Made anew if there are none yet.
std::shared_ptr<const ColourSpectra> spectra_in_white(const Scene& scene);

}  // namespace reemit
