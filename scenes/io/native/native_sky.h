#pragma once
#include <filesystem>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the object "sky" of a room file (docs/sky.md) into `scene`; `folder` is that of the room file.
void read_sky(const JsonCursor& sky, const std::filesystem::path& folder, Scene& scene);

}  // namespace reemit
