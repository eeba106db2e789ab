#pragma once
#include "scenes/model/luminaire.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// Starts one packet of a luminaire without area from four uniform numbers.
void start_light_ray(const PunctualLight& light, const RayScene& scene, float u0, float u1, float u2,
                     float u3, Ray16& rays, int lane);

/// Power of a luminaire without area [W] per band; of a directional light, the part that crosses the sphere
/// around the room: [W] = irradiance x pi R^2.
Spectrum light_power(const PunctualLight& light, const RayScene& scene);

}  // namespace reemit
