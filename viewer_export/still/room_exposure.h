#pragma once
#include "scenes/model/scene.h"
#include "solver/solution/solution.h"
#include "solver/trace/ray_scene.h"
#include "viewer_export/still/tone_map.h"

namespace reemit {

/// The tone map for pictures of a room that are not taken from one place, such as exported vertices: that of
/// a still which shows side by side what the room's cameras see, or the default ones if it has none. So an
/// export is as bright as the stills, and surfaces that nobody sees, inside and under things, do not count.
/// Reads the zones as they are, some thousand rays per camera. Throws as make_tone_map and RadianceField.
ToneMap tone_map_of_room(const Scene& scene, const Solution& solution, const RayScene& rays,
                         const ToneMapSettings& settings);

}  // namespace reemit
