#pragma once
#include <filesystem>

#include "scenes/io/scene_reader.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the Materials and Geometry Format [MGF]. The scene has not been through finish_scene.
/// Throws InputError with file and line.
Scene read_mgf_scene(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace reemit
