#pragma once
#include <array>
#include <cstdint>

#include "scenes/model/scene.h"

namespace reemit::hit_paths {

/// A room whose lamps touch what is around them: panels in the plane of the ceiling or a hair below it,
/// panels side by side, lamps with fins on them whose ends leave slivers, lamps in corners and on walls,
/// lamps with a corner cut out, glowing boxes that stand on the floor. Distances are 0 or random between 5e-8
/// and 1e-3 of the room and some lamps are tilted by a millionth. Rooms with even numbers are turned at
/// random, the others have coordinates rounded to a micrometre. A function of the number alone. It has one
/// camera.
Scene touching_lamps_room(std::uint32_t number);

/// The rooms that are compared: the first five, and fifteen of the first 300 in which the first triangle that
/// the mesher makes of a lamp is a sliver that welding has tilted.
constexpr std::array<std::uint32_t, 20> kTouchingLampsRooms{1,   2,   3,   4,   5,   35,  51,  53,  73,  107,
                                                            131, 141, 181, 191, 199, 207, 255, 287, 289, 297};

}  // namespace reemit::hit_paths
