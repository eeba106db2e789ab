#pragma once
#include <numbers>

#include "solver/sampling/warp.h"

namespace reemit {

// A surface that looks equally bright from everywhere: BRDF = rho/pi [1/sr] ([KRI08] last slide).

/// Value of the BRDF [1/sr] for a reflectance rho in [0,1].
inline float lambert_brdf_per_sr(float reflectance) {
  return reflectance * std::numbers::inv_pi_v<float>;
}

/// Radiance [W/(m2 sr)] sent back into every direction by a surface that receives `irradiance` [W/m2].
inline float lambert_reflected_radiance(float reflectance, float irradiance) {
  return lambert_brdf_per_sr(reflectance) * irradiance;
}

/// Direction of reflected (or, read backwards, incident) light about a unit normal. Its density
/// cosine_hemisphere_pdf_per_sr is proportional to BRDF times cosine, so each sample weighs exactly rho.
inline Vec3f sample_lambert(const Vec3f& normal, float u0, float u1) {
  return Frame(normal).to_world(sample_cosine_hemisphere(u0, u1));
}

}  // namespace reemit
