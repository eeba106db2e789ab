#pragma once
#include <filesystem>
#include <span>

#include "scenes/io/common/read_options.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads a room; the format follows from the extension: .json .obj .gltf .glb .mgf (case is ignored).
/// The result has been through finish_scene. Throws InputError with file and line (or JSON pointer).
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// The same for files, one or more, that are one room: only MGF has such rooms, read in order as one context.
/// Throws InputError for others.
Scene read_scene(std::span<const std::filesystem::path> files, const ReadOptions& options = {});

}  // namespace reemit
