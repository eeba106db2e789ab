#pragma once
#include <optional>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// Comma-separated values as RFC 4180 quotes them, after `#` comment lines; one row per vertex. Numbers are
/// the shortest that read back to the same value. Specified in docs/export_formats.md. Never returns a tone
/// map.
std::optional<ToneMap> write_csv(const VertexData& data, OutputFile& file);

/// The same in photometric units: luminance [cd/m2] and illuminance [lx] in place of the values of the bands.
/// Bands are carried by the same packets, so their errors are taken to go together fully: the standard error
/// of luminance is exact in a grey room and an upper bound in others.
std::optional<ToneMap> write_photometric_csv(const VertexData& data, OutputFile& file);

}  // namespace reemit
