#pragma once
#include <filesystem>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the arrays "lights" and "cameras" of a room file; `unit` is metres per unit of length, `folder` that
/// of the room file.
void read_lights(const JsonCursor& lights, double unit, const std::filesystem::path& folder, Scene& scene);
/// Throws InputError for two of the same name. Names that are missing become "camera 0" and so on.
void read_cameras(const JsonCursor& cameras, double unit, Scene& scene);

}  // namespace reemit
