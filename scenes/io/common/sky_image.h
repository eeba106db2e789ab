#pragma once
#include <filesystem>
#include <memory>

#include "scenes/model/bands.h"
#include "scenes/model/colour_spectra.h"
#include "scenes/model/sky.h"

namespace reemit {

/// Reads a latitude-longitude image (.hdr, .exr or whatever OpenImageIO knows) as radiance [W/(m2 sr)]:
/// linear Rec.709 values times `scale`, in a grey room their luminance, in a spectral one spectral_sky_image.
/// Images of more than 4096 columns are made smaller by averaging. Throws InputError for what is no such
/// image: a file that cannot be read, other than twice as wide as high, smaller than 16 x 8 pixels, values
/// that are negative or not a number, no light at all.
std::shared_ptr<const SkyImage> read_sky_image(const std::filesystem::path& file, double scale,
                                               double rotation_deg, const BandSet& bands);

/// An image of an RGB or grey room in the bands of `spectra`, colours as Upsampling::emission has them.
/// `white`: radiance by band that shows as red, green and blue of 1. Images of many bands are made smaller by
/// averaging, to some 270 MB.
std::shared_ptr<const SkyImage> spectral_sky_image(const SkyImage& image, const ColourSpectra& spectra,
                                                   const Spectrum& white);

}  // namespace reemit
