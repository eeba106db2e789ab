#pragma once
#include <filesystem>

#include "scenes/io/scene_reader.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads reemit's own room format. The scene has not been through finish_scene.
/// Throws InputError with  JSON, in metres:JSON pointer.
Scene read_native_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
