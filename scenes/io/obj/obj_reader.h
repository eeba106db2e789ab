#pragma once
#include <filesystem>

#include "scenes/io/common/read_options.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads Wavefront OBJ with its MTL files. The scene has not been through finish_scene.
/// Throws InputError with file and line.
Scene read_obj_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
