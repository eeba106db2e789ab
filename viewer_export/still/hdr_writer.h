#pragma once
#include <span>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// Radiance picture (RGBE) with a PRIMARIES line: without it Radiance would read the colours as those of its
/// own default primaries. Holds the picture only; the shared exponent keeps 8 bits per channel and no
/// negative value. `rgb`: the picture in linear Rec.709, 3 values per pixel. Throws ResourceError.
void write_hdr(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file);

}  // namespace reemit
