#include "scenes/io/mgf/mgf_material.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "scenes/model/colour.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

constexpr double kLumensPerWatt = 179;  // as BandSet::rgb

Eigen::Array3d to_rgb(const MgfColoured& coloured) {
  if (coloured.colour == MgfColour{}) return Eigen::Array3d::Constant(coloured.value);  // free of round-off
  return rec709_from_chromaticity(coloured.colour.x, coloured.colour.y, coloured.value);
}

// Moves colours that Rec.709 cannot hold into [0, most] and remembers that it did.
Eigen::Array3d fitted(const MgfColoured& coloured, double most, bool& changed) {
  constexpr double kVisible = 1e-4;
  const Eigen::Array3d rgb = to_rgb(coloured);
  const Eigen::Array3d clamped = clamp_to_gamut(rgb, most);
  changed = changed || ((rgb - clamped).abs() > kVisible * coloured.value).any();
  return clamped;
}

// Here the line of the number is known; the checks of the room could only name the material.
void check_strength(const Material& material, const MgfColoured& ed, const std::string& where) {
  const std::string problem = strength_problem(material.emitted_radiance, "the radiance [W/(m2 sr)]");
  if (!problem.empty())
    throw InputError(ed.given_at != nullptr ? *ed.given_at : where,
                     fmt::format("material '{}' with ed {:g}: {}", material.name, ed.value, problem),
                     kStrengthAdvice);
}

}  // namespace

Material convert_mgf_material(const MgfMaterial& m, const std::string& name, const std::string& where,
                              std::vector<std::string>& warnings) {
  Material material;
  material.name = name;
  bool changed = false;
  material.reflectance = fitted(m.rd, 1, changed);
  MgfColoured radiance = m.ed;
  radiance.value /= std::numbers::pi * kLumensPerWatt;
  material.emitted_radiance = fitted(radiance, std::numeric_limits<double>::infinity(), changed);
  check_strength(material, m.ed, where);
  material.two_sided = m.sides == 2;
  material.emits_both_sides = material.two_sided && m.ed.value > 0;

  NonDiffusePart& rest = material.non_diffuse;
  if (m.rs.value > 0) rest.specular_reflectance = fitted(m.rs, 1, changed);
  if (m.td.value > 0) rest.diffuse_transmittance = fitted(m.td, 1, changed);
  if (m.ts.value > 0) rest.specular_transmittance = fitted(m.ts, 1, changed);
  rest.roughness = m.rs_roughness;
  rest.transmission_roughness = m.ts_roughness;
  rest.lobe = GlossLobe::kWard;
  if (m.ir_real > 1 && m.ir_imaginary == 0) rest.index_of_refraction = m.ir_real;
  if (m.ir_imaginary != 0 && m.ir_real > 0 && m.rs.value > 0 && !(m.ts.value > 0)) {
    // rs is that of normal incidence, so the tint is what it leaves of Fresnel's equations to explain; where
    // it is more than they say, they tell nothing of it.
    const double n = m.ir_real;
    const double k = std::fabs(m.ir_imaginary);
    const double normal = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    const Spectrum most = normal * (1 - material.lambertian_share()).max(0);
    rest.angle_law = AngleLaw::kSchlick;
    if ((rest.specular_reflectance <= most).all()) {
      rest.angle_law = AngleLaw::kConductor;
      rest.metal_eta = Spectrum::Constant(material.reflectance.size(), n);
      rest.metal_k = Spectrum::Constant(material.reflectance.size(), k);
      rest.specular_reflectance = (most > 0).select(rest.specular_reflectance / most, 0);
    }
  }
  if (m.sides == 1 && rest.index_of_refraction > 1 && m.ts.value > 0 && rest.transmits_specularly()) {
    // One-sided and refracting: the surface of a body of glass. rs and ts are those of one passage through it
    // at normal incidence, so the tint is what Fresnel's equations leave to explain.
    const double n = rest.index_of_refraction;
    const double normal = (n - 1) * (n - 1) / ((n + 1) * (n + 1));
    rest.angle_law = AngleLaw::kDielectric;
    rest.is_solid = true;
    rest.specular_reflectance.resize(0);
    rest.specular_transmittance = (rest.specular_transmittance / (1 - normal)).min(1);
  }

  if (changed)
    warnings.push_back(fmt::format(
        "{}: material '{}' has a colour outside Rec.709; it was made paler, its luminance was kept.", where,
        name));
  return material;
}

}  // namespace reemit
