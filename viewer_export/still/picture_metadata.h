#pragma once
#include <string>
#include <utility>
#include <vector>

#include "viewer_export/still/still_image.h"

namespace reemit {

/// Program, room, units, seed, error and settings: names, which start with "reemit:" but for "Software", and
/// values.
std::vector<std::pair<std::string, std::string>> metadata_of(const StillImage& image);

}  // namespace reemit
