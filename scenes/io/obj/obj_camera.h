#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenes/model/camera.h"

namespace reemit {

/// The view in a text file beside an OBJ room, which has none itself. Lines, in any order:
///   eye X Y Z              [m]
///   direction X Y Z        or  look-at X Y Z
///   up X Y Z               default 0 1 0
///   horizontal fov A degrees   or  vertical fov A degrees
///   image W x H            [px]
/// Nothing, and a warning, if the file does not say where the eye is and where it looks, or has a line it
/// should not.
std::optional<Camera> read_obj_camera(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace reemit
