#pragma once
#include "scenes/io/json_cursor.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the arrays "lights" and "cameras" of a room file; `unit` is metres per unit of length.
void read_lights(const JsonCursor& lights, double unit, Scene& scene);
void read_cameras(const JsonCursor& cameras, double unit, Scene& scene);

}  // namespace reemit
