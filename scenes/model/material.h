#pragma once
#include <numbers>
#include <string>

#include "scenes/model/bands.h"
#include "scenes/model/material_textures.h"

namespace reemit {

/// How mirror reflection and clear transmission depend on the angle of the light.
enum class AngleLaw {
  kConstant,    ///< They do not: the numbers hold at every angle.
  kSchlick,     ///< R = r + (1-r) (1 - cos)^5, r at normal incidence: metals [SCH94, eq. 15].
  kConductor,   ///< Fresnel's equations for metal_eta and metal_k, times specular_reflectance as a tint.
  kDielectric,  ///< Fresnel's equations for the index of refraction; no specular_reflectance is given.
};

/// How light that is not reflected or transmitted sharply is spread (solver/reflect/gloss.h).
enum class GlossLobe { kGgx, kWard, kPhong };

/// What a surface does with light besides reflecting it as Lambert does.
struct NonDiffusePart {
  /// A reflected or transmitted beam of no more than this roughness is taken as a sharp one.
  static constexpr double kSmooth = 0.02;
  static constexpr double kLargestIndex = 100;  ///< Of refraction.

  Spectrum specular_reflectance;  ///< [0,1]; size 0 = none.
  /// Index of refraction eta - i k of a metal, by band; > 0 and >= 0. Of kConductor, else size 0.
  Spectrum metal_eta, metal_k;
  /// alpha of GGX and Ward's lobe [0,1], 0 = mirror; Phong's exponent is 2/alpha^2 - 2 [WAL07].
  double roughness = 0;
  Spectrum diffuse_transmittance;  ///< Into all directions beyond [0,1]; size 0 = none.
  /// [0,1]; size 0 = none. With kDielectric, of the glass alone: of a pane, for one pass across it at normal
  /// incidence; of a solid, a tint of what crosses the surface. Else of the whole.
  Spectrum specular_transmittance;
  double transmission_roughness = 0;  ///< As roughness.
  GlossLobe lobe = GlossLobe::kGgx;
  double index_of_refraction = 1;  ///< Of what is behind the front to what is before it [1, 100].
  AngleLaw angle_law = AngleLaw::kConstant;
  /// The faces bound a body of glass: their backs are its inside, and light is refracted. Else a face is a
  /// thin pane, which light crosses straight on.
  bool is_solid = false;
  Spectrum absorption_per_m;  ///< Of the inside of a solid [1/m], >= 0; size 0 = none.

  /// Whether a share is there and not 0 in all bands.
  static bool is_given(const Spectrum& share) { return share.size() > 0 && (share > 0).any(); }
  /// Sharply or spread.
  bool reflects_specularly() const {
    return angle_law == AngleLaw::kDielectric || is_given(specular_reflectance);
  }
  bool transmits_specularly() const { return is_given(specular_transmittance); }
  bool transmits_diffusely() const { return is_given(diffuse_transmittance); }
  /// Whether it sends light on another way than straight through, and not diffusely: over it, luminaires
  /// throw caustics.
  bool bends_light() const {
    return reflects_specularly() || (transmits_specularly() && (is_solid || has_glossy_transmission()));
  }
  bool has_gloss() const { return reflects_specularly() && roughness > kSmooth; }
  bool has_glossy_transmission() const { return transmits_specularly() && transmission_roughness > kSmooth; }
};

/// Reflection, transmission and self-emission of a surface. Behaviour lives in solver/reflect and
/// solver/emit.
struct Material {
  std::string name;
  Spectrum reflectance;       ///< Diffuse (Lambertian) reflectance rho [0,1] per band; BRDF = rho/pi.
  Spectrum back_reflectance;  ///< That of the back [0,1], if it differs; size 0 = it does not.
  Spectrum emitted_radiance;  ///< L_e [W/(m2 sr)] per band along the normal; all 0 = no luminaire.
  /// e in L_e(theta) = emitted_radiance cos^e(theta): 0 = Lambertian, larger = a narrower beam [0, 1e4].
  double emission_exponent = 0;
  /// Where the emission was given as the power of all surfaces with this material: their emitting area [m2]
  /// that it was divided by; else 0. Once they are meshed, spread_total_powers settles it.
  double area_of_total_power = 0;
  bool two_sided = true;  ///< The back reflects like the front; else the back of the face absorbs all light.
  bool emits_both_sides = false;  ///< Else only the front emits. Needs two_sided.
  NonDiffusePart non_diffuse;
  MaterialTextures textures;  ///< What of it varies; reflectance and emission above are then means.

  const Spectrum& reflectance_of(bool front) const {
    return front || back_reflectance.size() == 0 ? reflectance : back_reflectance;
  }
  double diffuse_transmittance(std::size_t band) const {
    const Spectrum& tau = non_diffuse.diffuse_transmittance;
    return tau.size() > 0 ? tau[static_cast<Eigen::Index>(band)] : 0;
  }
  /// Of the side and, where that is known, the point that reflects more.
  Spectrum largest_reflectance() const {
    Spectrum most = reflectance;
    for (const Spectrum* other : {&back_reflectance, &textures.most_reflectance})
      if (other->size() > 0) most = most.max(*other);
    return most;
  }
  /// Reflected and transmitted diffusely, by band, of the side that reflects more.
  Spectrum lambertian_share() const {
    return non_diffuse.transmits_diffusely()
               ? Spectrum(largest_reflectance() + non_diffuse.diffuse_transmittance)
               : largest_reflectance();
  }
  /// Reflected and transmitted by band, all together, of the side that reflects more. The tint of glass
  /// (kDielectric), as that of metals (kConductor), is no share of its own.
  Spectrum share_of_light() const {
    Spectrum sum = largest_reflectance();
    const Spectrum none;
    const bool is_tint = non_diffuse.angle_law == AngleLaw::kDielectric;
    const bool is_metal = non_diffuse.angle_law == AngleLaw::kConductor;
    for (const Spectrum* s :
         {is_metal ? &none : &non_diffuse.specular_reflectance, &non_diffuse.diffuse_transmittance,
          is_tint ? &none : &non_diffuse.specular_transmittance})
      if (s->size() > 0) sum += *s;
    return sum;
  }
  /// Above this share_of_light() is more than rounding.
  static constexpr double kAllLight = 1 + 1e-9;
  bool emits() const { return (emitted_radiance > 0).any(); }
  /// Emitted by a square metre of one side [W/m2] per band: the integral of L_e cos(theta) over the
  /// hemisphere.
  Spectrum exitance() const { return 2 * std::numbers::pi / (emission_exponent + 2) * emitted_radiance; }
};

}  // namespace reemit
