#pragma once
#include <filesystem>

#include "viewer_export/points/measured_light.h"

namespace reemit {

/// Writes light at points as a table, one row per point (docs/export_formats.md); the file appears whole or
/// not at all. Throws ResourceError when it cannot be written.
void write_points_csv(const MeasuredLight& light, const std::filesystem::path& file);

}  // namespace reemit
