#include "scenes/io/obj_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "scenes/io/text_file.h"
#include "scenes/io/text_parse.h"
#include "scenes/io/texture_average.h"
#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargestMtl = std::uintmax_t{64} << 20;

// Numbers a statement of a MTL file must have. tinyobjloader reads what is missing or garbled as 0.
struct NumberRule {
  std::string_view keyword;
  std::size_t least, most;  // how many
  double low, high;         // allowed values
};
constexpr double kAny = 1e300;
constexpr std::array kRules = {
    NumberRule{"Kd", 1, 3, 0, 1},        NumberRule{"Ks", 1, 3, 0, 1}, NumberRule{"Ke", 1, 3, 0, kAny},
    NumberRule{"Ka", 1, 3, -kAny, kAny}, NumberRule{"Tf", 1, 3, 0, 1}, NumberRule{"Ns", 1, 1, 0, kAny},
    NumberRule{"Ni", 1, 1, 0, kAny},     NumberRule{"d", 1, 1, 0, 1},  NumberRule{"Tr", 1, 1, 0, 1},
    NumberRule{"illum", 1, 1, 0, 10},
};

// The words of a numeric statement up to a comment.
std::vector<std::string_view> without_comment(const TextLine& line) {
  const auto comment =
      std::find_if(line.words.begin(), line.words.end(), [](auto word) { return word[0] == '#'; });
  return {line.words.begin(), comment};
}

std::string checked_numbers(const NumberRule& rule, const TextLine& line, const std::string& where) {
  const std::vector<std::string_view> words = without_comment(line);
  const std::size_t count = words.size() - 1;
  if (count > 0 && (words[1] == "spectral" || words[1] == "xyz"))
    throw InputError(where, fmt::format("'{} {}' is not supported", rule.keyword, words[1]),
                     "Give red, green, blue.");
  if (count < rule.least || count > rule.most || count == 2)
    throw InputError(where, fmt::format("'{}' has {} numbers", rule.keyword, count),
                     rule.most == 3 ? "Give red, green, blue." : "Give one number.");
  std::string text(rule.keyword);
  for (std::size_t i = 1; i <= count; ++i) {
    const auto value = parse_number(words[i]);
    if (!value || *value < rule.low || *value > rule.high)
      throw InputError(
          where, fmt::format("'{} {}' is not a number in its range", rule.keyword, words[i]),
          rule.high == 1 ? "Give a fraction from 0 to 1." : "Give a finite number of 0 or more.");
    text += fmt::format(" {}", words[i]);
  }
  if (rule.most == 3 && count == 1)
    text += fmt::format(" {0} {0}", words[1]);  // one number stands for all three
  return text + "\n";
}

// What tinyobjloader gets to read: checked, one statement per line, numbers without comments.
std::string checked_text(const std::string& text, const std::string& name) {
  std::string clean;
  bool in_material = false;
  for (const TextLine& line : split_lines(text)) {
    if (line.words[0][0] == '#') continue;
    const std::string where = at_line(name, line.number);
    if (line.words[0] == "newmtl") {
      if (line.words.size() < 2) throw InputError(where, "'newmtl' has no name", "Name the material.");
      in_material = true;
    } else if (!in_material) {
      throw InputError(where, fmt::format("'{}' before the first 'newmtl'", line.words[0]),
                       "Is this a MTL file, and is it complete?");
    }
    const auto* rule = std::find_if(kRules.begin(), kRules.end(),
                                    [&](const NumberRule& r) { return r.keyword == line.words[0]; });
    if (rule != kRules.end())
      clean += checked_numbers(*rule, line, where);
    else
      clean += fmt::format("{} {}\n", line.words[0], rest_of(line, 1));
  }
  return clean;
}

Spectrum spectrum_of(const tinyobj::real_t (&rgb)[3]) {
  return Eigen::Array3d(rgb[0], rgb[1], rgb[2]);
}

// Light that goes straight through: 1 - d, coloured by Tf; Tf alone in the refracting illumination models.
Spectrum transmittance_of(const tinyobj::material_t& m) {
  const Spectrum filter = spectrum_of(m.transmittance);
  const bool refracts = m.illum == 6 || m.illum == 7;
  const double share = m.dissolve < 1 ? 1 - m.dissolve : (refracts ? 1 : 0);
  if ((filter > 0).any()) return share * filter;
  return m.dissolve < 1 ? Spectrum::Constant(3, share) : Spectrum::Zero(3);
}

std::string ignored_maps(const tinyobj::material_t& m) {
  std::string maps;
  const auto add = [&maps](const char* keyword, const std::string& file) {
    if (!file.empty()) maps += fmt::format("{}{} {}", maps.empty() ? "" : ", ", keyword, file);
  };
  add("map_Ke", m.emissive_texname);
  add("map_Ks", m.specular_texname);
  add("map_Ns", m.specular_highlight_texname);
  add("map_d", m.alpha_texname);
  add("bump", m.bump_texname);
  add("norm", m.normal_texname);
  add("disp", m.displacement_texname);
  add("refl", m.reflection_texname);
  return maps;
}

Spectrum textured_reflectance(const tinyobj::material_t& m, const fs::path& folder, const std::string& where,
                              std::vector<std::string>& warnings) {
  const Spectrum kd = spectrum_of(m.diffuse);
  if (m.diffuse_texname.empty()) return kd;
  std::string relative = m.diffuse_texname;
  std::replace(relative.begin(), relative.end(), '\\', '/');
  const TextureAverage average = average_texture(folder / relative);
  if (!average.problem.empty()) {
    warnings.push_back(fmt::format("{}: Kd {:.3g} {:.3g} {:.3g} is used in place of the texture: {}", where,
                                   kd[0], kd[1], kd[2], average.problem));
    return kd;
  }
  warnings.push_back(fmt::format("{}: the texture {} is used as its average colour {:.3g} {:.3g} {:.3g}.",
                                 where, relative, average.rgb[0], average.rgb[1], average.rgb[2]));
  return average.rgb;
}

Material convert(const tinyobj::material_t& m, const fs::path& file, std::vector<std::string>& warnings) {
  const std::string where = fmt::format("{}: material '{}'", file.string(), m.name);
  Material material;
  material.name = m.name;
  material.reflectance = textured_reflectance(m, file.parent_path(), where, warnings);
  material.emitted_radiance = spectrum_of(m.emission);
  NonDiffusePart& rest = material.non_diffuse;
  if (const Spectrum ks = spectrum_of(m.specular); (ks > 0).any()) rest.specular_reflectance = ks;
  if (const Spectrum through = transmittance_of(m); (through > 0).any())
    rest.specular_transmittance = through;
  rest.roughness = std::sqrt(2 / (m.shininess + 2));  // Phong exponent to microfacet roughness [WAL07]
  rest.index_of_refraction = m.ior;
  if (const std::string maps = ignored_maps(m); !maps.empty())
    warnings.push_back(fmt::format("{}: ignored: {}.", where, maps));
  return material;
}

}  // namespace

void ObjMaterials::read(const fs::path& file, const std::string& where) {
  std::string text;
  try {
    text = load_file(file, kLargestMtl);
  } catch (const InputError& error) {
    throw InputError(where, std::string("the material file cannot be read: ") + error.what(), "");
  }
  std::istringstream stream(checked_text(text, file.string()));
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> loaded;
  std::string ignored_warning, ignored_error;  // about what checked_text has refused
  tinyobj::LoadMtl(&names, &loaded, &stream, &ignored_warning, &ignored_error);
  for (const tinyobj::material_t& m : loaded) {
    if (m.name.empty()) continue;
    if (!index_.try_emplace(m.name, materials.size()).second) {
      warnings.push_back(fmt::format("{}: material '{}' is defined again; the first definition counts.",
                                     file.string(), m.name));
      continue;
    }
    materials.push_back(convert(m, file, warnings));
  }
}

}  // namespace reemit
