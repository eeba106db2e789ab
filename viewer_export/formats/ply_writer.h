#pragma once
#include <optional>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// Binary little-endian PLY: geometry, tone-mapped 8-bit colours, luminance as `quality`, and all radiometric
/// values as float properties; backs lie off their fronts. Specified in docs/export_formats.md. Positions are
/// double instead of float in a room so far from 0 that float would lose them. Throws InputError for more
/// than 2^31-1 vertices.
std::optional<ToneMap> write_ply(const VertexData& data, OutputFile& file);

}  // namespace reemit
