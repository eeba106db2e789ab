#pragma once
#include <numbers>
#include <string>

#include "scenes/model/bands.h"

namespace reemit {

/// What of a material the diffuse solver does not model. Kept so that nothing is dropped silently, and later
/// work finds it.
struct NonDiffusePart {
  Spectrum specular_reflectance;    ///< [0,1]; size 0 = none.
  double roughness = 0;             ///< Ward-like roughness [0,1]; 0 = mirror.
  Spectrum diffuse_transmittance;   ///< [0,1]; size 0 = none.
  Spectrum specular_transmittance;  ///< [0,1]; size 0 = none.
  double transmission_roughness = 0;
  double index_of_refraction = 1;
};

/// Reflection and self-emission of a surface. Behaviour lives in solver/reflect and solver/emit.
struct Material {
  std::string name;
  Spectrum reflectance;       ///< Diffuse (Lambertian) reflectance rho [0,1] per band; BRDF = rho/pi.
  Spectrum emitted_radiance;  ///< L_e [W/(m2 sr)] per band along the normal; all 0 = no luminaire.
  /// e in L_e(theta) = emitted_radiance cos^e(theta): 0 = Lambertian, larger = a narrower beam [0, 1e4].
  double emission_exponent = 0;
  bool two_sided = true;  ///< The back reflects like the front; else the back of the face absorbs all light.
  bool emits_both_sides = false;  ///< Else only the front emits. Needs two_sided.
  NonDiffusePart non_diffuse;

  bool emits() const { return (emitted_radiance > 0).any(); }
  /// Emitted by a square metre of one side [W/m2] per band: the integral of L_e cos(theta) over the
  /// hemisphere.
  Spectrum exitance() const { return 2 * std::numbers::pi / (emission_exponent + 2) * emitted_radiance; }
};

}  // namespace reemit
