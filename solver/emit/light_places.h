#pragma once
#include <vector>

#include "scenes/model/scene.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Distance that a luminaire without area keeps from flat faces [normalised units of RayTracer].
inline constexpr double kLightClearance = 2e-5;

/// The lights of a room, in its order, as packets and shadow rays start at them: one whose position lies on a
/// face, or nearer to it than kLightClearance on either side, stands that far before it. Otherwise rounding
/// would decide on which side of the face its rays start. `Before` a one-sided face is its front. A two-sided
/// one is lit on the side that a spot is aimed at, else on the side of the middle of the room. What such a
/// light sends towards the face lands on it around the light.
std::vector<PunctualLight> lights_before_faces(const Scene& scene, const RayTracer& rays);

}  // namespace reemit
