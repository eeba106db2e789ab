#pragma once
#include <Eigen/Core>

#include "scenes/model/bands.h"

namespace reemit {

/// A spectrum for a colour.
struct Upsampled {
  Spectrum values;
  /// Largest component of its colour less the one asked for, over the largest one asked for: 0 up to rounding
  /// unless the bands are too few to have the colour.
  double deviation = 0;
};

/// Spectra for linear Rec.709 colours: for reflectances sigmoids of quadratic polynomials of the wavelength
/// [JH19], averaged over the bands; their three coefficients are solved for each colour. The
/// colour of a spectrum is that of BandSet::to_rgb where the bands cover the visible range; else that of 5 nm
/// from 360 to 830, of which the bands get their part.
class Upsampling {
 public:
  /// Pre: `bands` are spectral. `light`: the colour, each component above 0, of the light under which
  /// reflectances have their colours, as spread by emission(); equal components are equal-energy white.
  explicit Upsampling(const BandSet& bands, const Eigen::Array3d& light = Eigen::Array3d::Ones());

  /// A reflectance in [0, most] that sends back `rgb` x the colour of the light. `rgb` in [0, most], 0 < most
  /// <= 1. Equal components become a constant.
  Upsampled reflectance(const Eigen::Array3d& rgb, double most = 1) const;

  /// An emission of this colour and luminance, in the unit of `rgb`, within each band: equal-energy white
  /// times a sigmoid that is at most half of saturated, as [PBRT4, section 4.6.6] has it, scaled. Components
  /// >= 0. A room of one band gets the luminance.
  Upsampled emission(const Eigen::Array3d& rgb) const;

 private:
  struct Sigmoid {
    Eigen::Vector3d coefficients;
    double residual;  ///< Norm of the colour that is missed.
  };
  Sigmoid solve(const Eigen::Matrix3Xd& colour_of, const Eigen::Vector3d& rgb) const;

  BandSet bands_;
  BandSet observer_;
  Eigen::Matrix3Xd white_;  ///< Colour of a reflectance by bands of the observer, in equal-energy white,
  Eigen::Matrix3Xd lit_;    ///< and in `light`.
};

}  // namespace reemit
