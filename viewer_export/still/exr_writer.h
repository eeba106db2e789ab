#pragma once
#include <span>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// OpenEXR: 32-bit float channels R, G, B and every layer the picture has, with chromaticities,
/// whiteLuminance and the settings as metadata. Layer names are in docs/export_formats.md. `rgb`: the picture
/// in linear Rec.709, 3 values per pixel. Compressed on as many threads as the task arena of the caller has,
/// of one caller at a time. Throws ResourceError.
void write_exr(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file);

}  // namespace reemit
