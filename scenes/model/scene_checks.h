#pragma once
#include "scenes/model/scene.h"

namespace reemit {

// The steps of finish_scene. Each throws InputError that names the material, surface, face, light or camera.

/// Gives every spectrum its size (an empty one becomes 0) and checks ranges: reflectance [0,1], radiance >=
/// 0.
void check_materials(Scene& scene);

/// Removes surfaces without faces and checks indices and coordinates; a face whose shading normals are
/// unusable becomes flat, with one warning for the room.
void check_geometry(Scene& scene);

/// Refuses emitting surfaces that have no area at all: their power would be lost.
void check_luminous_surfaces(const Scene& scene);

/// Intensities finite, >= 0 and not 0 in all bands, cone angles in order; directions become unit vectors.
void check_lights(Scene& scene);

/// Strengths finite, >= 0 and not 0 in all bands, the sun above the horizon.
void check_sky(Scene& scene);

/// Checks views and makes camera names unique by a suffix.
void check_cameras(Scene& scene);

}  // namespace reemit
