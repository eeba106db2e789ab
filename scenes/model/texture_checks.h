#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Whether a texture or the colours of vertices are other than grey.
bool has_coloured_textures(const Scene& scene);

/// Checks what finish_scene says of textures and their coordinates: throws InputError at coordinates that are
/// not finite or out of range, and at textures in rooms of spectral bands; warns of faces whose material has
/// textures but that have no coordinates. Sets MaterialTextures::most_reflectance. After check_materials.
void check_textures(Scene& scene);

}  // namespace reemit
