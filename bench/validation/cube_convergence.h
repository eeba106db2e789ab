#pragma once
#include <string>
#include <vector>

#include "bench/validation/validation_row.h"

namespace reemit::validation {

/// Irradiance in the cube whose face z0 emits, at a point or as the mean of a face, by zones of one size.
struct CubeStep {
  double rho = 0;
  std::string place;      ///< "mean of z0" or "x0(0.5,0.1)": face and position on it.
  int divisions = 0;      ///< Each face has 2 divisions^2 triangular zones.
  double continuous = 0;  ///< Of the continuous equation.
  /// Exact zonal system of divisions x divisions squares per face; 0 where it is not known.
  double square_zones = 0;
  ValidationRow zones;         ///< Shooting: mean of the zones, or the zone at the point.
  ValidationRow plain_gather;  ///< Gather that reads every zone it hits.
  ValidationRow gather;        ///< Gather as the program has it: close hits are carried on.
};

/// What zones and gathers make of the cube with reflectance 0.5 and 0.8. Needs the cases cube1.* and
/// cubezones.*.
std::vector<CubeStep> measure_cube_convergence(const std::vector<ReferenceCase>& cases, const Effort& effort);

}  // namespace reemit::validation
