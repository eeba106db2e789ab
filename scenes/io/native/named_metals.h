#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenes/model/bands.h"

namespace reemit {

/// Index of refraction eta - i k of a metal, by band.
struct OpticalConstants {
  Spectrum eta;
  Spectrum k;
};

/// Names for metal_constants().
std::vector<std::string> metal_names();

/// Measured constants of a polished metal [HGK74], linear between the samples: at the centres of spectral
/// bands; at 611, 549 and 464 nm, the dominant wavelengths of the primaries, in RGB rooms; at 555 nm in grey
/// ones. Beyond the samples, 413 to 689 nm at least, the nearest. Pre: `name` is one of metal_names().
OpticalConstants metal_constants(const std::string& name, const BandSet& bands);

}  // namespace reemit
