#pragma once
#include <optional>

#include "bench/hit_paths/path_random.h"
#include "bench/hit_paths/polygon_room.h"

namespace reemit::hit_paths {

/// By band, what the lobes of a surface make of light from the direction `to`, on either side, for a path
/// that came along `direction` [1/sr]; besides Lambertian reflection. Light that rough bodies of glass
/// refract is not in it.
Spectrum rough_value(const RoomHit& hit, const Vec3& direction, const Vec3& to);

/// A way on from a rough surface, and by band its share of the light over its density.
struct RoughWay {
  Vec3 direction{0, 0, 1};
  Spectrum weight;
};

/// Draws a way on that is mirrored, or across. Pre: that is what the surface spreads. Nothing where light is
/// lost.
std::optional<RoughWay> draw_rough_mirror(const RoomHit& hit, const Vec3& direction, PathRandom& random);
std::optional<RoughWay> draw_rough_across(const RoomHit& hit, const Vec3& direction, PathRandom& random);

}  // namespace reemit::hit_paths
