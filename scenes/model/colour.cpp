#include "scenes/model/colour.h"

#include <algorithm>

#include <Eigen/LU>

namespace reemit {
namespace {

Eigen::Vector3d xyz_of_chromaticity(double x, double y) {
  return {x / y, 1, (1 - x - y) / y};
}

Eigen::Vector3d d65() {
  return xyz_of_chromaticity(0.3127, 0.3290);
}

// Columns are the XYZ of the Rec.709 primaries at the amounts that add up to D65.
Eigen::Matrix3d rec709_to_xyz() {
  Eigen::Matrix3d primaries;
  primaries.col(0) = xyz_of_chromaticity(0.64, 0.33);
  primaries.col(1) = xyz_of_chromaticity(0.30, 0.60);
  primaries.col(2) = xyz_of_chromaticity(0.15, 0.06);
  const Eigen::Vector3d amounts = primaries.inverse() * d65();
  return primaries * amounts.asDiagonal();
}

// Bradford transform [LIN09] from equal-energy white to D65.
Eigen::Matrix3d adapt_e_to_d65() {
  Eigen::Matrix3d cones;
  cones << 0.8951, 0.2664, -0.1614,  //
      -0.7502, 1.7135, 0.0367,       //
      0.0389, -0.0685, 1.0296;
  const Eigen::Vector3d from = cones * Eigen::Vector3d::Ones();
  const Eigen::Vector3d to = cones * d65();
  return cones.inverse() * to.cwiseQuotient(from).asDiagonal() * cones;
}

}  // namespace

Eigen::Array3d rec709_luminance_weights() {
  return {0.2126, 1.0 - 0.2126 - 0.0722, 0.0722};
}

Eigen::Matrix3d xyz_to_rec709() {
  const Eigen::Matrix3d adapted = rec709_to_xyz().inverse() * adapt_e_to_d65();
  // Adaptation does not keep Y of saturated colours. Adding the missing luminance as grey keeps the map
  // linear, keeps white white, and makes photometric sums exact.
  const Eigen::RowVector3d luminance = rec709_luminance_weights().matrix().transpose() * adapted;
  return adapted + Eigen::Vector3d::Ones() * (Eigen::RowVector3d(0, 1, 0) - luminance);
}

Eigen::Array3d rec709_from_chromaticity(double x, double y, double luminance) {
  return (xyz_to_rec709() * xyz_of_chromaticity(x, y)).array() * luminance;
}

Eigen::Array3d clamp_to_gamut(const Eigen::Array3d& rgb, double most) {
  const double grey = std::clamp((rec709_luminance_weights() * rgb).sum(), 0.0, most);
  double keep = 1;  // how much of the distance from grey may stay
  for (const double value : rgb) {
    if (value < 0) keep = std::min(keep, grey / (grey - value));
    if (value > most) keep = std::min(keep, (most - grey) / (value - grey));
  }
  return (grey + keep * (rgb - grey)).max(0.0).min(most);
}

}  // namespace reemit
