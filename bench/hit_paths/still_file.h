#pragma once
#include <filesystem>

#include "viewer_export/still/still_image.h"

namespace reemit::hit_paths {

/// Radiance and its standard error from an EXR file of the program. Throws std::invalid_argument if it is not
/// one, or of other bands.
StillImage read_still(const std::filesystem::path& file, const BandSet& bands);

}  // namespace reemit::hit_paths
