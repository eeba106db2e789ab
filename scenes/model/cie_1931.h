#pragma once
#include <Eigen/Core>

namespace reemit {

/// Colour matching functions (xbar, ybar, zbar) of the CIE 1931 2 degree observer [CIE04], linear between the
/// values tabulated every 5 nm; ybar is V(lambda). Zero outside 360 ... 830 nm.
Eigen::Vector3d cie_1931(double wavelength_nm);

/// Mean of cie_1931 over a range of wavelengths [nm], from <= to; the value itself where they are equal.
Eigen::Vector3d mean_cie_1931(double from_nm, double to_nm);

}  // namespace reemit
