#pragma once
#include <vector>

#include "scenes/model/camera.h"
#include "scenes/model/scene.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// The way that is up: +y or +z, unit. Where the format leaves it open (MGF, OBJ), the luminaires tell if
/// nearly all of them shine down along one of the two; else +z for MGF and +y for all others.
Vec3 up_direction(const Scene& scene);

/// One to three cameras for a room that has none, named auto-1, auto-2, ... Eyes stand in the free space at
/// eye height, away from surfaces, and look level where the view is deepest; each further camera looks
/// another way. A room without free space (a lone polygon) is shown from outside. Deterministic. Pre: `rays`
/// has triangles.
std::vector<Camera> default_cameras(const Scene& scene, const RayScene& rays);

}  // namespace reemit
