#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// The way that is up, +y or +z: that of the sky where it is one of them; what all cameras of a native or OBJ
/// room say; else the custom of the format, +z for MGF and +y for all others. MGF and OBJ leave it open:
/// there the luminaires overrule the format where nearly all of their surfaces shine along the other axis,
/// and the room is no higher along that axis than along the custom one: a lamp in a wall of a room that is
/// wider than high says nothing.
Vec3 up_direction(const Scene& scene);

}  // namespace reemit
