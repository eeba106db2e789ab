#pragma once
#include <optional>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// Binary glTF 2.0: one mesh and node per surface, unlit, COLOR_0 tone-mapped, radiometric values in
/// `_RADIANCE` and its companions; a node turns rooms with z up, backs lie off their fronts. Specified in
/// docs/export_formats.md. glTF allows no infinite or undefined number: those are written as the largest
/// float and as 0. Throws InputError when nothing is left to draw or the file would exceed the 4 GiB of the
/// format.
std::optional<ToneMap> write_glb(const VertexData& data, OutputFile& file);

}  // namespace reemit
