#pragma once
#include <filesystem>

#include "scenes/io/common/read_options.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads glTF 2.0, text or binary (docs/gltf_input.md). The scene has not been through finish_scene.
/// Throws InputError that names the node, mesh and primitive, accessor or JSON pointer.
Scene read_gltf_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
