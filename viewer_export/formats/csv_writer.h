#pragma once
#include <optional>

#include "scenes/io/output_file.h"
#include "viewer_export/still/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// Comma-separated values as RFC 4180 quotes them, after `#` comment lines; one row per vertex. Numbers are
/// the shortest that read back to the same value. Specified in docs/export_formats.md. Never returns a tone
/// map.
std::optional<ToneMap> write_csv(const VertexData& data, OutputFile& file);

}  // namespace reemit
