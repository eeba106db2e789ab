#pragma once
#include "solver/sampling/shapes/shape_density.h"

namespace reemit {

// The density with the least error per time, shadow ray included, by docs/luminaire_densities.md. `distance`:
// from the shading point to the middle of the luminaire, over the diameter of the sphere around it.

/// The same at any distance.
inline Density density_of_sphere() {
  return Density::kCosine;
}
/// By `distance`, >= 0.
inline Density density_of_polygon(double distance) {
  return distance < 0.6 ? Density::kCosine : distance < 2 ? Density::kSolidAngle : Density::kArea;
}
inline Density density_of_disk(double distance) {
  return distance < 0.6 ? Density::kCosine : distance < 2 ? Density::kSolidAngle : Density::kArea;
}
inline Density density_of_cylinder(double distance) {
  return distance < 0.6 ? Density::kCosine : Density::kSolidAngle;
}

}  // namespace reemit
