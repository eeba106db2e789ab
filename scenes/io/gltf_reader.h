#pragma once
#include <filesystem>

#include "scenes/io/scene_reader.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads glTF 2.0, text or binary. The scene has not been through finish_scene.
/// Throws InputError with JSON pointer.
Scene read_gltf_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
