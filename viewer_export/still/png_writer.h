#pragma once
#include <span>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// 8-bit sRGB, tone-mapped and dithered; the exposure is stated in the metadata. The same picture gives the
/// same bytes. `rgb`: the picture in linear Rec.709, 3 values per pixel. Throws ResourceError.
void write_png(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file);

}  // namespace reemit
