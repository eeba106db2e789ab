#pragma once
#include "bench/hit_paths/polygon_room.h"

namespace reemit::hit_paths {

/// By band, the shares of arriving light that a surface sends on as a mirror does and that cross it, sharply
/// or spread by a lobe.
struct SpecularShares {
  Spectrum mirrored;
  Spectrum crossing;
};

/// What docs/materials.md says of a material for light at an angle to the normal of one of its sides, or of a
/// facet of it, worked out apart from the solver: mirrors, metals, clear sheets, panes and bodies of glass.
SpecularShares specular_shares(const Material& material, double angle, bool front);

/// By band, the share that a side reflects into all directions.
Spectrum reflected_diffusely(const Material& material, bool front);
/// By band, the share that is let through into all directions.
Spectrum let_through(const Material& material);

/// Whether a lobe spreads what is mirrored or what crosses.
bool is_rough_mirror(const Material& material);
bool is_rough_across(const Material& material);

/// Angle [rad] of a ray of unit direction to the normal where it met the room.
double arrival_angle(const RoomHit& hit, const Vec3& direction);

Vec3 mirrored(const RoomHit& hit, const Vec3& direction);
/// Straight on, or bent by the surface of a body of glass. Pre: not all light is reflected.
Vec3 crossing(const RoomHit& hit, const Vec3& direction);

/// Index of refraction behind a side of a body of glass over that before it.
double index_ratio(const Material& material, bool front);

/// Whether light that crosses the material enters or leaves a body of glass.
bool is_body(const Material& material);

/// By band, what is left of light after a way [m] inside a body of glass.
Spectrum left_inside(const Material& body, double way);

}  // namespace reemit::hit_paths
