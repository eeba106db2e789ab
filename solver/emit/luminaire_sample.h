#pragma once
#include "scenes/model/vec.h"

namespace reemit {

/// Where a shadow ray from a point x goes to a luminaire, and what arrives if it gets through. Normalised
/// space.
struct LuminaireSample {
  float factor = 0;  ///< Irradiance per unit of strength over the density of the sample; 0: x is not lit.
  bool at_infinity = false;  ///< `target` is a unit direction towards the luminaire, else a point.
  Vec3f target{0, 0, 0};     ///< A ray origin just off the luminaire.
  /// Density of the direction, among those to this luminaire [1/sr]; 0 where no ray from x can meet the
  /// luminaire, so that nothing but such a sample finds its light.
  float pdf_per_sr = 0;

  /// Towards the luminaire from where the shadow ray starts; unit only at infinity.
  Vec3f towards(const Vec3f& origin) const { return at_infinity ? target : Vec3f(target - origin); }
};

}  // namespace reemit
