#pragma once
#include "bench/hit_paths/polygon_room.h"

namespace reemit::hit_paths {

/// By band, the shares of arriving light that a smooth surface sends on as a mirror does and that cross it.
struct SmoothShares {
  Spectrum mirrored;
  Spectrum crossing;
};

/// What docs/materials.md says of a material for light at an angle to the normal of one of its sides, worked
/// out apart from the solver: mirrors, metals, clear sheets, panes and bodies of glass. Gloss has no part in
/// it.
SmoothShares smooth_shares(const Material& material, double angle, bool front);

/// Angle [rad] of a ray of unit direction to the normal where it met the room.
double arrival_angle(const RoomHit& hit, const Vec3& direction);

Vec3 mirrored(const RoomHit& hit, const Vec3& direction);
/// Straight on, or bent by the surface of a body of glass. Pre: not all light is reflected.
Vec3 crossing(const RoomHit& hit, const Vec3& direction);

/// Whether light that crosses the material enters or leaves a body of glass.
bool is_body(const Material& material);

/// By band, what is left of light after a way [m] inside a body of glass.
Spectrum left_inside(const Material& body, double way);

}  // namespace reemit::hit_paths
