#pragma once
#include <filesystem>
#include <span>

#include "scenes/io/common/read_options.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the Materials and Geometry Format [MGF]. The scene has not been through finish_scene.
/// Throws InputError with file and line.
Scene read_mgf_scene(const std::filesystem::path& file, const ReadOptions& options);

/// The same for files, one or more, that are one room: read in order, each sees the colours, materials and
/// vertices that those before it leave.
Scene read_mgf_files(std::span<const std::filesystem::path> files);

}  // namespace reemit
