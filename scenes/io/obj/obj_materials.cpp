#include "scenes/io/obj/obj_materials.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiny_obj_loader.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/obj/blender_mtl.h"
#include "scenes/io/obj/find_named_file.h"
#include "scenes/io/obj/mtl_text.h"
#include "scenes/io/obj/obj_light_shares.h"
#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargestMtl = std::uintmax_t{64} << 20;
constexpr double kGrey = 0.5;  // reflectance of materials that nobody defines

Spectrum spectrum_of(const tinyobj::real_t (&rgb)[3]) {
  return Eigen::Array3d(rgb[0], rgb[1], rgb[2]);
}

std::string ignored_maps(const tinyobj::material_t& m) {
  std::string maps;
  const auto add = [&maps](const char* keyword, const std::string& file) {
    if (!file.empty()) maps += fmt::format("{}{} {}", maps.empty() ? "" : ", ", keyword, file);
  };
  add("map_Ks", m.specular_texname);
  add("map_Ns", m.specular_highlight_texname);
  add("bump", m.bump_texname);
  add("norm", m.normal_texname);
  add("disp", m.displacement_texname);
  add("refl", m.reflection_texname);
  return maps;
}

// Where what is said of a material goes.
struct Telling {
  std::vector<std::string>& warnings;
  KindCounts& refused;
  KindCounts& not_modelled;
  std::vector<std::string>& notes;
};

// A texture as its statement has it: -s and -o, then (0,0) is the lower left corner of the image.
Texture texture_of(const tinyobj::texture_option_t& options, std::shared_ptr<const TextureImage> image) {
  Texture texture;
  texture.image = std::move(image);
  if (options.clamp) texture.wrap_u = texture.wrap_v = TextureWrap::kClamp;
  const auto at = [](const tinyobj::real_t& x) { return static_cast<double>(x); };
  texture.to_image << at(options.scale[0]), 0, at(options.origin_offset[0]), 0, -at(options.scale[1]),
      1 - at(options.origin_offset[1]);
  return texture;
}

// Reads the maps of one material.
class MapReader {
 public:
  MapReader(TextureImages& images, const fs::path& folder, const std::string& where, Telling& tell)
      : images_(images), folder_(folder), where_(where), tell_(tell) {}

  // Null where there is none, or none that can be read, which is told: `instead` of it.
  Texture read(const std::string& name, const tinyobj::texture_option_t& options, TextureEncoding encoding,
               const std::string& instead) {
    if (name.empty()) return {};
    const fs::path found = find_named_file(folder_, name);
    std::string as_named = name;
    std::replace(as_named.begin(), as_named.end(), '\\', '/');
    const fs::path named = folder_ / as_named;
    TextureRead read = images_.from_file(found.empty() ? named : found, encoding);
    if (read.problem.empty() && !found.empty() && found != named)
      tell_.warnings.push_back(fmt::format("{}: there is no texture '{}'; '{}' is taken.", where_,
                                           named.string(), found.string()));
    if (!read.problem.empty()) {
      ++tell_.refused["textures"];
      tell_.warnings.push_back(
          fmt::format("{}: {} is used in place of the texture: {}", where_, instead, read.problem));
      return {};
    }
    const std::string note = reduction_note(*read.image);
    if (!note.empty() && std::find(tell_.notes.begin(), tell_.notes.end(), note) == tell_.notes.end())
      tell_.notes.push_back(note);
    return texture_of(options, std::move(read.image));
  }

 private:
  TextureImages& images_;
  const fs::path& folder_;
  const std::string& where_;
  Telling& tell_;
};

Spectrum mean_of(const Texture& texture) {
  const Texel& mean = texture.image->mean;
  return Eigen::Array3d(mean[0], mean[1], mean[2]);
}

void read_opacity_map(const tinyobj::material_t& m, MapReader& maps, Material& material) {
  Texture opacity = maps.read(m.alpha_texname, m.alpha_texopt, TextureEncoding::kLinear, "d");
  if (!opacity) return;
  material.textures.opacity_is_colour = !opacity.image->has_opacity;
  material.textures.opacity_factor = static_cast<double>(m.dissolve);
  material.textures.opacity = std::move(opacity);
}

void read_emission_map(const tinyobj::material_t& m, const std::string& where, MapReader& maps, Telling& tell,
                       Material& material) {
  Texture emission = maps.read(m.emissive_texname, m.emissive_texopt, TextureEncoding::kSrgb, "Ke");
  if (!emission) return;
  if (!material.emits()) {
    tell.warnings.push_back(fmt::format("{}: its map_Ke emits nothing, because Ke is 0.", where));
    return;
  }
  material.textures.emission_factor = material.emitted_radiance;
  material.emitted_radiance *= mean_of(emission);
  material.textures.emission = std::move(emission);
}

Material convert(const tinyobj::material_t& m, const fs::path& file, TextureImages& images, Telling tell) {
  const std::string where = fmt::format("{}: material '{}'", file.string(), m.name);
  Material material;
  material.name = m.name;
  const fs::path folder = file.parent_path();
  MapReader maps(images, folder, where, tell);
  const Spectrum kd = spectrum_of(m.diffuse);
  Texture colour = maps.read(m.diffuse_texname, m.diffuse_texopt, TextureEncoding::kSrgb,
                             fmt::format("Kd {:.3g} {:.3g} {:.3g}{}", kd[0], kd[1], kd[2],
                                         (kd >= 1).any() ? ", which absorbs nothing," : ""));
  read_opacity_map(m, maps, material);
  const ObjLightShares shares = obj_light_shares(
      {colour ? Spectrum(Spectrum::Ones(3)) : kd, spectrum_of(m.specular), spectrum_of(m.transmittance),
       material.textures.opacity ? 1.0 : static_cast<double>(m.dissolve), m.ior, m.illum});
  material.reflectance = shares.diffuse;
  if (colour) {
    material.textures.reflectance_factor = material.reflectance;
    material.reflectance *= mean_of(colour);
    material.textures.reflectance = std::move(colour);
  }
  material.emitted_radiance = spectrum_of(m.emission);
  read_emission_map(m, where, maps, tell, material);
  NonDiffusePart& rest = material.non_diffuse;
  if ((shares.specular > 0).any()) rest.specular_reflectance = shares.specular;
  if ((shares.transmitted > 0).any()) rest.specular_transmittance = shares.transmitted;
  if (!shares.doubt.empty()) {
    ++tell.not_modelled["glass_and_mirrors_as_paint"];
    tell.warnings.push_back(fmt::format("{}: {}.", where, shares.doubt));
  }
  // Phong exponent to microfacet roughness [WAL07].
  rest.roughness = shares.is_sharp ? 0 : std::sqrt(2 / (m.shininess + 2));
  rest.lobe = GlossLobe::kPhong;
  if (shares.is_metal) rest.angle_law = AngleLaw::kSchlick;
  if (shares.is_glass) {
    rest.angle_law = AngleLaw::kDielectric;
    rest.is_solid = true;
    rest.index_of_refraction = static_cast<double>(m.ior);
  }
  if (m.ior < 1 && (shares.transmitted > 0).any())
    tell.warnings.push_back(fmt::format(
        "{}: Ni {:.3g} is below 1: light crosses it straight on, as a thin sheet; window glass has 1.5.",
        where, m.ior));
  if (const std::string ignored = ignored_maps(m); !ignored.empty()) {
    ++tell.not_modelled["other_maps"];
    tell.warnings.push_back(fmt::format("{}: ignored: {}.", where, ignored));
  }
  return material;
}

// What a dielectric reflects at normal incidence: its index of refraction is about 1.5.
constexpr double kVarnish = 0.04;

// Ks as programs write it that add a highlight to the light that Kd reflects: together they are more than
// there is. Left as a share it would take the place of Kd, and the surface would absorb nothing. Whether it
// is such a one.
bool make_highlight_a_varnish(Material& material) {
  NonDiffusePart& part = material.non_diffuse;
  if (!part.reflects_specularly() || part.roughness == 0 || part.angle_law == AngleLaw::kSchlick)
    return false;
  Spectrum left = 1 - material.reflectance;
  if (part.transmits_specularly()) left -= part.specular_transmittance;
  constexpr double kRounded = 1e-6;
  if (!(part.specular_reflectance > left + kRounded).any()) return false;
  part.specular_reflectance = left.max(0).min(kVarnish);
  if (!(part.specular_reflectance > 0).any()) part.specular_reflectance.resize(0);
  return true;
}

// Names, not too many of them.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  const std::size_t shown = std::min(names.size(), kMost);
  return fmt::format("{}{}",
                     fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     names.size() > shown ? ", ..." : "");
}

// Of Blender's metals, in place of Phong's lobe.
void make_metal(double roughness, NonDiffusePart& part) {
  part.roughness = roughness;
  part.lobe = GlossLobe::kGgx;
  part.angle_law = AngleLaw::kSchlick;
}

}  // namespace

void ObjMaterials::read(const fs::path& folder, const std::string& name, const std::string& where) {
  const fs::path file = find_named_file(folder, name);
  if (file.empty()) {
    ++refused["material_files"];
    warnings_.push_back(fmt::format("{}: there is no material file '{}'; its materials are taken as grey.",
                                    where, (folder / name).string()));
    return;
  }
  if (file != folder / name)
    warnings_.push_back(fmt::format("{}: there is no material file '{}'; '{}' is taken.", where,
                                    (folder / name).string(), file.string()));
  std::string text;
  try {
    text = load_file(file, kLargestMtl);
  } catch (const InputError& error) {
    ++refused["material_files"];
    warnings_.push_back(
        fmt::format("{}: the material file cannot be read, and its materials are taken as grey: {}", where,
                    error.what()));
    return;
  }
  std::istringstream stream(checked_mtl_text(text, file.string(), notes, warnings_));
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> loaded;
  std::string ignored_warning, ignored_error;  // about what checked_mtl_text has refused
  tinyobj::LoadMtl(&names, &loaded, &stream, &ignored_warning, &ignored_error);
  const bool by_blender = is_written_by_blender(text);
  std::vector<std::string> highlights;  // names of materials whose Ks is no share of the light
  for (tinyobj::material_t& m : loaded) {
    if (m.name.empty()) continue;
    Material* place = place_of(m.name == kNoMaterialName ? "" : m.name);
    if (place == nullptr) {
      warnings_.push_back(fmt::format("{}: material '{}' is defined again; the first definition counts.",
                                      file.string(), m.name));
      continue;
    }
    const std::optional<double> metal = by_blender ? read_as_written_by_blender(m) : std::nullopt;
    *place = convert(m, file, images_, {warnings_, refused, not_modelled, notes});
    if (make_highlight_a_varnish(*place)) highlights.push_back(fmt::format("'{}'", m.name));
    if (metal) make_metal(*metal, place->non_diffuse);
  }
  if (!highlights.empty())
    warnings_.push_back(fmt::format(
        "{}: Kd and Ks come to more than 1 in {} material(s): {}. Such a Ks, the strength of a highlight, is "
        "taken as the gloss of varnish: {} of the light.",
        file.string(), highlights.size(), listed(highlights), kVarnish));
  if (by_blender) notes.push_back(file.string() + ": " + kBlenderNote);
}

Material* ObjMaterials::place_of(const std::string& name) {
  const auto [entry, added] = index_.try_emplace(name, materials.size());
  if (added) return &materials.emplace_back();
  const std::size_t material = entry->second;
  const auto asked = std::find_if(undefined_.begin(), undefined_.end(),
                                  [&](const Undefined& u) { return u.material == material; });
  if (asked == undefined_.end()) return nullptr;
  undefined_.erase(asked);
  if (--refused["materials"] == 0) refused.erase("materials");
  return &materials[material];
}

std::size_t ObjMaterials::index_of(const std::string& name, const std::string& where) {
  const auto [entry, added] = index_.try_emplace(name, materials.size());
  if (!added) return entry->second;
  Material material;
  material.name = name.empty() ? kNoMaterialName : name;
  material.reflectance = Spectrum::Constant(3, kGrey);
  material.emitted_radiance = Spectrum::Zero(3);
  materials.push_back(std::move(material));
  ++refused["materials"];
  undefined_.push_back(
      {name.empty() ? "faces without 'usemtl'" : fmt::format("'{}'", name), where, entry->second});
  return entry->second;
}

std::vector<std::string> ObjMaterials::warnings() const {
  std::vector<std::string> all = warnings_;
  if (undefined_.empty()) return all;
  std::vector<std::string> names;
  for (const Undefined& u : undefined_) names.push_back(u.shown);
  all.push_back(fmt::format("{}: {} material(s) are not defined and are taken as grey, reflectance {}: {}.",
                            undefined_.front().at, names.size(), kGrey, listed(names)));
  return all;
}

}  // namespace reemit
