#include "scenes/io/native/native_materials.h"

#include <numbers>

#include <fmt/format.h>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/native/named_metals.h"
#include "scenes/io/native/native_textures.h"
#include "scenes/model/limits.h"

namespace reemit {

namespace {

/// Here the place of the number is known; the checks of the room could only name the material.
void check_strength(const Spectrum& radiance, const JsonCursor& at) {
  const std::string problem = strength_problem(radiance, "the radiance [W/(m2 sr)]");
  if (!problem.empty()) at.fail(problem, kStrengthAdvice);
}

/// The keys that set the emission; at most one of them may stand in a material.
constexpr const char* kEmissionKeys[] = {"radiance",       "exitance",    "luminance_cd_m2",
                                         "exitance_lm_m2", "total_power", "total_flux_lm"};

const char* emission_key(const JsonCursor& at) {
  const char* found = nullptr;
  for (const char* key : kEmissionKeys) {
    if (!at.find(key)) continue;
    if (found)
      at.at(key).fail(fmt::format("the emission is already given by \"{}\"", found), "Keep one of the two.");
    found = key;
  }
  return found;
}

bool is_photometric(const std::string& key) {
  return key == "luminance_cd_m2" || key == "exitance_lm_m2" || key == "total_flux_lm";
}

void expect_material(const JsonCursor& at) {
  at.expect_object({"reflectance",
                    "back_reflectance",
                    "radiance",
                    "exitance",
                    "luminance_cd_m2",
                    "exitance_lm_m2",
                    "total_power",
                    "total_flux_lm",
                    "emission_color",
                    "emission_exponent",
                    "sides",
                    "emission_sides",
                    "mirror",
                    "metal",
                    "transmittance",
                    "diffuse_transmittance",
                    "glass",
                    "roughness",
                    "lobe",
                    "texture",
                    "emission_texture",
                    "opacity",
                    "opacity_texture",
                    "opacity_cutoff"});
}

void read_reflectances(const JsonCursor& at, const BandSet& bands, Material& material) {
  const auto reflectance = at.find("reflectance");
  material.reflectance = reflectance ? read_reflectance(*reflectance, bands)
                                     : Spectrum(Spectrum::Zero(static_cast<Eigen::Index>(bands.count())));
  const auto back = at.find("back_reflectance");
  if (!back) return;
  material.back_reflectance = read_reflectance(*back, bands);
  const auto sides = at.find("sides");
  if (sides && sides->choice({"both", "front"}) == "front")
    back->fail("the back of this material absorbs everything",
               "Remove \"back_reflectance\", or \"sides\": \"front\".");
}

void read_sides(const JsonCursor& at, Material& material) {
  const std::vector<std::string> choices{"front", "both"};
  if (const auto sides = at.find("sides")) material.two_sided = sides->choice(choices) == "both";
  if (const auto sides = at.find("emission_sides")) {
    material.emits_both_sides = sides->choice(choices) == "both";
    if (material.emits_both_sides && !material.two_sided) {
      sides->fail("a one-sided surface cannot emit from its back", "Set \"sides\": \"both\".");
    }
  }
}

/// "roughness" of what goes on as a ray, and the "lobe" that it spreads to.
void read_gloss(const JsonCursor& at, NonDiffusePart& part) {
  const auto roughness = at.find("roughness");
  const auto lobe = at.find("lobe");
  if (lobe && !roughness) lobe->fail("a lobe without a roughness", "Give the \"roughness\", 0 to 1.");
  if (!roughness) return;
  if (!part.reflects_specularly() && !part.transmits_specularly())
    roughness->fail("a roughness of nothing: the material is Lambertian",
                    "Give a \"mirror\", \"metal\", \"transmittance\" or \"glass\" share too.");
  part.roughness = part.transmission_roughness = roughness->number_in(0, 1);
  if (!lobe) return;
  const std::string name = lobe->choice({"ggx", "ward", "phong"});
  part.lobe = name == "ward" ? GlossLobe::kWard : name == "phong" ? GlossLobe::kPhong : GlossLobe::kGgx;
}

/// A metal by its share at normal incidence, its name, or its "eta" and "k".
void read_metal(const JsonCursor& at, const BandSet& bands, NonDiffusePart& part) {
  const auto count = static_cast<Eigen::Index>(bands.count());
  const bool has_constants = at.is_object() && (at.find("eta") || at.find("k"));
  if (!at.is_string() && !has_constants) {
    part.angle_law = AngleLaw::kSchlick;
    part.specular_reflectance = read_reflectance(at, bands);
    return;
  }
  part.angle_law = AngleLaw::kConductor;
  part.specular_reflectance = Spectrum::Ones(count);
  if (at.is_string()) {
    OpticalConstants constants = metal_constants(at.choice(metal_names()), bands);
    part.metal_eta = std::move(constants.eta);
    part.metal_k = std::move(constants.k);
    return;
  }
  at.expect_object({"eta", "k"});
  part.metal_eta = read_optical_constant(at.at("eta"), bands);
  part.metal_k = read_optical_constant(at.at("k"), bands);
  if (!(part.metal_eta > 0).all()) at.at("eta").fail("an eta of 0", "Give more than 0 in every band.");
}

/// The keys of what goes on as a ray: "mirror" or "metal", "transmittance", "diffuse_transmittance", or
/// "glass" alone.
void read_specular(const JsonCursor& at, const BandSet& bands, Material& material) {
  NonDiffusePart& part = material.non_diffuse;
  const auto mirror = at.find("mirror");
  const auto metal = at.find("metal");
  const auto clear = at.find("transmittance");
  const auto opal = at.find("diffuse_transmittance");
  const auto glass = at.find("glass");
  if (mirror && metal)
    metal->fail("the material is already a mirror", "Keep one of \"mirror\" and \"metal\".");
  if (glass && (mirror || metal || clear || opal))
    glass->fail(
        "glass already says what it reflects and lets through",
        "Remove \"mirror\", \"metal\", \"transmittance\" and \"diffuse_transmittance\", or \"glass\".");
  if (mirror) part.specular_reflectance = read_reflectance(*mirror, bands);
  if (metal) read_metal(*metal, bands, part);
  if (clear && part.angle_law == AngleLaw::kConductor)
    clear->fail("a metal with eta and k lets nothing through",
                "Give the shares of a half-silvered sheet as \"mirror\" and \"transmittance\".");
  if (clear) part.specular_transmittance = read_reflectance(*clear, bands);
  if (opal) part.diffuse_transmittance = read_reflectance(*opal, bands);
  if (const double most = material.share_of_light().maxCoeff(); most > Material::kAllLight)
    at.fail(fmt::format("the surface reflects and transmits {:.6g} of the light in one band", most),
            "Make its \"reflectance\", \"mirror\" or \"metal\", \"transmittance\" and "
            "\"diffuse_transmittance\" add up "
            "to at most 1.");
  if (!glass) return;
  glass->expect_object({"ior", "transmittance", "solid", "transmittance_per_m"});
  part.angle_law = AngleLaw::kDielectric;
  part.index_of_refraction = glass->at("ior").number_in(1, NonDiffusePart::kLargestIndex);
  part.specular_transmittance = Spectrum::Ones(static_cast<Eigen::Index>(bands.count()));
  if (const auto tint = glass->find("transmittance"))
    part.specular_transmittance = read_reflectance(*tint, bands);
  if (const auto solid = glass->find("solid")) part.is_solid = solid->boolean();
  if (const auto inside = glass->find("transmittance_per_m")) {
    if (!part.is_solid)
      inside->fail("a pane has no thickness", "Give its \"transmittance\", or set \"solid\": true.");
    const Spectrum left = read_reflectance(*inside, bands);
    if (!(left > 0).all()) inside->fail("glass that lets nothing through", "Give more than 0 in every band.");
    part.absorption_per_m = -left.log();
  }
}

/// Radiance along the normal; of a Lambertian surface, M / pi.
Spectrum radiance_of_exitance(const Spectrum& exitance, const Material& material) {
  return (material.emission_exponent + 2) / (2 * std::numbers::pi) * exitance;
}

}  // namespace

NativeMaterials::NativeMaterials(const JsonCursor& materials, const std::filesystem::path& folder,
                                 Scene& scene) {
  NativeTextures textures(folder, scene);
  for (const auto& [name, at] : materials.members()) {
    expect_material(at);
    if (name.empty()) at.fail("a material needs a name", "Name it.");
    Material material;
    material.name = name;
    read_reflectances(at, scene.bands, material);
    read_specular(at, scene.bands, material);
    read_gloss(at, material.non_diffuse);
    read_sides(at, material);
    const MaterialId id(scene.materials.size());
    read_emission_of(at, id, scene.bands, material);
    textures.read(at, material);
    ids_.emplace(name, id);
    scene.materials.push_back(std::move(material));
  }
}

void NativeMaterials::read_emission_of(const JsonCursor& at, MaterialId id, const BandSet& bands,
                                       Material& material) {
  const char* emission = emission_key(at);
  const std::string key = emission ? emission : "";
  const auto colour = at.find("emission_color");
  if (colour && !is_photometric(key)) {
    colour->fail("a colour without a photometric emission",
                 "Use it with luminance_cd_m2, exitance_lm_m2 or total_flux_lm.");
  }
  if (const auto exponent = at.find("emission_exponent")) {
    if (!emission)
      exponent->fail("an exponent without an emission", "Say how much it emits, or remove the exponent.");
    material.emission_exponent = exponent->number_in(0, 1e4);
  }
  material.emitted_radiance = Spectrum::Zero(static_cast<Eigen::Index>(bands.count()));
  if (!emission) return;
  const JsonCursor given = at.at(emission);
  const Spectrum value = is_photometric(key) ? photometric_emission(given.strength(), colour, bands)
                                             : read_emission(given, bands);
  if (!(value > 0).any())
    given.fail(fmt::format("the material \"{}\" emits nothing, though its emission is given", material.name),
               "Remove the emission or give it power.");
  if (key == "total_power" || key == "total_flux_lm") {
    totals_.push_back({given, id, value});
    return;
  }
  const bool is_exitance = key == "exitance" || key == "exitance_lm_m2";
  material.emitted_radiance = is_exitance ? radiance_of_exitance(value, material) : value;
  check_strength(material.emitted_radiance, given);
}

MaterialId NativeMaterials::find(const JsonCursor& name) const {
  const auto it = ids_.find(name.string());
  if (it != ids_.end()) return it->second;
  std::vector<std::string> names;
  for (const auto& [known, id] : ids_) names.push_back(known);
  name.fail(fmt::format("there is no material \"{}\"", name.string()), known_names(name.string(), names));
}

MaterialId NativeMaterials::import(Material material, Scene& scene) {
  const std::string wanted = material.name;
  for (int i = 2; ids_.contains(material.name); ++i) material.name = fmt::format("{} #{}", wanted, i);
  const MaterialId id(scene.materials.size());
  ids_.emplace(material.name, id);
  scene.materials.push_back(std::move(material));
  return id;
}

void NativeMaterials::share_total_powers(Scene& scene) const {
  for (const TotalPower& total : totals_) {
    Material& material = scene.materials[total.material.index()];
    double area = 0;
    for (const Surface& surface : scene.surfaces) {
      if (surface.material == total.material) area += surface_area(surface);
    }
    if (material.emits_both_sides) area *= 2;
    if (!(area > 0)) {
      scene.warnings.push_back(fmt::format(
          "{}: no surface of the room has the material '{}', so it sends out nothing of its power",
          total.at.where(), material.name));
      continue;
    }
    material.emitted_radiance = radiance_of_exitance(total.power / area, material);
    material.area_of_total_power = area;
    check_strength(material.emitted_radiance, total.at);
  }
}

}  // namespace reemit
