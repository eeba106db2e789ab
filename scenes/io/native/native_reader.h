#pragma once
#include <filesystem>

#include "scenes/io/common/read_options.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads a room in reemit's own JSON format (docs/room_format.md). The scene has not been through
/// finish_scene. Throws InputError with file and JSON pointer.
Scene read_native_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
