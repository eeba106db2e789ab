#pragma once
#include <cstdint>
#include <vector>

#include "solver/room/room.h"

namespace reemit {

/// A straight piece of the way of light: nothing lies in between.
struct LightLeg {
  Vec3f origin{0, 0, 0};     ///< Normalised, as of the rays.
  Vec3f direction{0, 0, 1};  ///< Unit.
  float length = 0;          ///< Normalised; 1, half the size of the room, where the light leaves it.
};

/// Which way light goes in a room, found by a few thousand packets that leave the luminaires as they do in a
/// solve and are reflected a few times. Its legs cross exactly the space that light reaches: not the inside
/// of solids, nor the void in a wall, nor what lies behind the faces of the room.
struct LitSpace {
  std::vector<LightLeg> legs;
  std::vector<Vec3f> lit_points;   ///< Ends of legs on sides that reflect, normalised.
  std::vector<Vec3f> lit_normals;  ///< Of those sides, unit.
  float width = 0;  ///< Half of the way of light goes along longer legs; normalised, 0 without legs.
};

/// From the luminaires; nothing where there are none. Deterministic.
LitSpace trace_light(const Room& room);
/// As if all zones emitted alike: for rooms without luminaires, and for those that keep their light to
/// themselves.
LitSpace trace_from_all_surfaces(const Room& room);

}  // namespace reemit
