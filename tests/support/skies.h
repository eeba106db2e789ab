#pragma once
#include "scenes/model/sky.h"

namespace reemit::test {

/// A sky over z with its horizontal irradiance [W/m2] in all of `bands` bands, over black ground.
inline Sky sky_over_z(SkyKind kind, double irradiance, std::size_t bands = 1) {
  Sky sky;
  sky.kind = kind;
  sky.description = "test";
  sky.irradiance = Spectrum::Constant(static_cast<Eigen::Index>(bands), irradiance);
  sky.ground_reflectance = Spectrum::Zero(static_cast<Eigen::Index>(bands));
  place_sky(sky, Vec3::UnitZ());
  return sky;
}

/// One of the CIE general skies; the sun, which sends nothing, stands 40 degrees high in the east-south-east.
inline Sky cie_sky_over_z(int type, double irradiance, std::size_t bands = 1) {
  Sky sky = sky_over_z(SkyKind::kGeneral, irradiance, bands);
  sky.gradation = SkyGradation::of_cie_type(type);
  sky.sun = Sun{0.7, 1.9, {}, Sun::kHalfAngle};
  return sky;
}

}  // namespace reemit::test
