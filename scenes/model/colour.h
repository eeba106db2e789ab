#pragma once
#include <Eigen/Core>

namespace reemit {

/// Luminance weights of linear Rec.709 red, green and blue [ITU709]; they sum to exactly 1.
Eigen::Array3d rec709_luminance_weights();

/// Linear Rec.709 colour of CIE XYZ values that are relative to equal-energy white: (1,1,1) becomes neutral.
/// Bradford adaptation from illuminant E to D65, then the Rec.709 primaries, then the neutral part is shifted
/// so that rec709_luminance_weights give exactly Y for every colour. Colours outside the gamut have negative
/// components.
Eigen::Matrix3d xyz_to_rec709();

/// Linear Rec.709 colour with luminance Y and CIE 1931 chromaticity (x,y), y > 0; see xyz_to_rec709.
Eigen::Array3d rec709_from_chromaticity(double x, double y, double luminance);

/// The nearest colour with the same luminance weights that lies in [0, most] per component: moves towards the
/// grey of equal luminance. Luminance is kept as far as [0, most] allows.
Eigen::Array3d clamp_to_gamut(const Eigen::Array3d& rgb, double most);

}  // namespace reemit
