#pragma once
#include <filesystem>
#include <memory>

#include "scenes/model/bands.h"
#include "scenes/model/sky.h"

namespace reemit {

/// Reads a latitude-longitude image (.hdr, .exr or whatever OpenImageIO knows) as radiance [W/(m2 sr)]:
/// linear Rec.709 values times `scale`. A spectral room gets their luminance, equal in all bands. Images of
/// more than 4096 columns are made smaller by averaging. Throws InputError for what is no such image: a file
/// that cannot be read, other than twice as wide as high, smaller than 16 x 8 pixels, values that are
/// negative or not a number, no light at all.
std::shared_ptr<const SkyImage> read_sky_image(const std::filesystem::path& file, double scale,
                                               double rotation_deg, const BandSet& bands);

}  // namespace reemit
