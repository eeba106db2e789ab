#include "scenes/io/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {

namespace {

using Rgb = Eigen::Array3d;

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

constexpr const char* kDiffuseTransmission = "KHR_materials_diffuse_transmission";
constexpr const char* kVolume = "KHR_materials_volume";
constexpr const char* kIor = "KHR_materials_ior";
constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kClearCoat = "KHR_materials_clearcoat";

/// What a body of this index of refraction reflects at normal incidence.
double normal_reflectance(double ior) {
  return std::pow((ior - 1) / (ior + 1), 2);
}

/// Reads the materials of one file.
class MaterialReader {
 public:
  MaterialReader(const GltfModel& gltf, const GltfAccessors& accessors, const GltfUnits& units, Scene& scene)
      : gltf_(gltf), textures_(gltf, accessors), units_(units), scene_(scene) {}

  void read_all() {
    std::set<std::string> ignored;
    for (std::size_t i = 0; i < gltf_.model.materials.size(); ++i) {
      const tinygltf::Material& source = gltf_.model.materials[i];
      where_ = fmt::format("/materials/{}", i);
      scene_.materials.push_back(read(source));
      if (scene_.materials.back().name.empty()) scene_.materials.back().name = fmt::format("material {}", i);
      for (const auto& [name, value] : source.extensions) {
        static const std::set<std::string> known{"KHR_materials_emissive_strength",
                                                 "KHR_materials_transmission",
                                                 kIor,
                                                 kSpecular,
                                                 kClearCoat,
                                                 kVolume,
                                                 kSpecularGlossiness,
                                                 kDiffuseTransmission};
        if (!known.contains(name)) ignored.insert(name);
      }
    }
    if (!ignored.empty()) {
      scene_.not_modelled["material_extensions"] += ignored.size();
      scene_.warnings.push_back(fmt::format("material extensions are ignored: {}", fmt::join(ignored, ", ")));
    }
  }

 private:
  /// `pointer`: from the material, as "pbrMetallicRoughness/metallicFactor".
  [[noreturn]] void fail(const std::string& pointer, const std::string& problem,
                         const std::string& advice) const {
    throw InputError(gltf_.at(where_ + "/" + pointer), problem, advice);
  }

  double checked(double value, double most, const std::string& pointer) const {
    if (!(value >= 0 && value <= most)) {
      fail(pointer, fmt::format("{} is {}", last_of(pointer), value),
           fmt::format("It must lie from 0 to {}.", most));
    }
    return value;
  }

  static std::string last_of(const std::string& pointer) {
    return pointer.substr(pointer.find_last_of('/') + 1);
  }

  Rgb rgb(const std::vector<double>& values, double most, const std::string& pointer) const {
    if (values.size() < 3)
      fail(pointer, fmt::format("{} has {} components", last_of(pointer), values.size()),
           "Give three or four.");
    return {checked(values[0], most, pointer), checked(values[1], most, pointer),
            checked(values[2], most, pointer)};
  }

  static std::string in_extension(const char* extension, const char* key) {
    return fmt::format("extensions/{}/{}", extension, key);
  }

  /// A number of an extension, or `otherwise`.
  double number(const tinygltf::Material& source, const char* name, const char* key, double otherwise,
                double most) const {
    const tinygltf::Value& object = extension(source, name);
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    const std::string pointer = in_extension(name, key);
    if (!value.IsNumber()) fail(pointer, fmt::format("{} is not a number", key), "Export the file anew.");
    return checked(value.GetNumberAsDouble(), most, pointer);
  }

  Rgb triple(const tinygltf::Material& source, const char* name, const char* key, double most = 1) const {
    const tinygltf::Value& object = extension(source, name);
    if (!object.IsObject() || !object.Has(key)) return Rgb::Ones();
    const tinygltf::Value& value = object.Get(key);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < value.ArrayLen(); ++i) {
      const tinygltf::Value& item = value.Get(static_cast<int>(i));
      numbers.push_back(item.IsNumber() ? item.GetNumberAsDouble() : -1);
    }
    return rgb(numbers, most, in_extension(name, key));
  }

  const tinygltf::Value& extension(const tinygltf::Material& source, const char* name) const {
    static const tinygltf::Value nothing;
    const auto it = source.extensions.find(name);
    return it == source.extensions.end() ? nothing : it->second;
  }

  /// The mean of a texture, 1 where there is none or it cannot be read; warns in both cases where there is
  /// one.
  Rgb mean(int texture, TextureEncoding encoding, const char* what, const std::string& name) {
    if (texture < 0) return Rgb::Ones();
    const std::optional<Rgb> value = textures_.mean(texture, encoding, where_);
    if (!value) {
      ++scene_.refused["textures"];
      scene_.warnings.push_back(
          fmt::format("material \"{}\": its {} texture cannot be read and counts as white", name, what));
      return Rgb::Ones();
    }
    ++scene_.not_modelled["textures"];
    scene_.warnings.push_back(
        fmt::format("material \"{}\": its {} texture is replaced by its mean {:.3f} {:.3f} {:.3f}", name,
                    what, (*value)[0], (*value)[1], (*value)[2]));
    return *value;
  }

  void read_metallic_roughness(const tinygltf::Material& source, Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const std::string within = "pbrMetallicRoughness/";
    const Rgb base = rgb(pbr.baseColorFactor, 1, within + "baseColorFactor") *
                     mean(pbr.baseColorTexture.index, TextureEncoding::kSrgb, "base colour", material.name);
    // Green holds the roughness, blue the metallic share.
    const Rgb packed = mean(pbr.metallicRoughnessTexture.index, TextureEncoding::kLinear,
                            "metallic-roughness", material.name);
    const double metallic = checked(pbr.metallicFactor, 1, within + "metallicFactor") * packed[2];
    const double roughness = checked(pbr.roughnessFactor, 1, within + "roughnessFactor") * packed[1];
    material.non_diffuse.roughness = roughness * roughness;  // alpha, by the definition of the format
    const double transmitted = number(source, "KHR_materials_transmission", "transmissionFactor", 0, 1);
    const double through = number(source, kDiffuseTransmission, "diffuseTransmissionFactor", 0, 1);
    const double diffuse = (1 - metallic) * (1 - transmitted);
    material.reflectance = base * (diffuse * (1 - through));
    if (through > 0)
      material.non_diffuse.diffuse_transmittance =
          triple(source, kDiffuseTransmission, "diffuseTransmissionColorFactor") * (diffuse * through);
    if (metallic > 0) {
      material.non_diffuse.specular_reflectance = base * metallic;
      material.non_diffuse.angle_law = AngleLaw::kSchlick;
    }
    if (transmitted > 0) {
      material.non_diffuse.specular_transmittance = base * ((1 - metallic) * transmitted);
      material.non_diffuse.transmission_roughness = material.non_diffuse.roughness;
      material.non_diffuse.index_of_refraction = std::max(1.0, index_of_refraction(source));
      if (metallic == 0) material.non_diffuse.angle_law = AngleLaw::kDielectric;
      read_volume(source, material.non_diffuse);
      return;
    }
    add_dielectric_gloss(source, metallic, material);
  }

  double index_of_refraction(const tinygltf::Material& source) const {
    return number(source, kIor, "ior", 1.5, NonDiffusePart::kLargestIndex);
  }

  /// What files say of the gloss of their dielectrics and of clear coats; without a word it counts as
  /// diffuse.
  void add_dielectric_gloss(const tinygltf::Material& source, double metallic, Material& material) {
    NonDiffusePart& part = material.non_diffuse;
    Rgb gloss = Rgb::Zero();
    if (extension(source, kSpecular).IsObject()) {
      constexpr double kMostColour = 1e6;
      gloss = triple(source, kSpecular, "specularColorFactor", kMostColour) *
              normal_reflectance(index_of_refraction(source));
      gloss = gloss.min(1) * number(source, kSpecular, "specularFactor", 1, 1);
      gloss *= (1 - metallic);
    }
    if (const double coat = number(source, kClearCoat, "clearcoatFactor", 0, 1); coat > 0) {
      const double roughness = number(source, kClearCoat, "clearcoatRoughnessFactor", 0, 1);
      if (metallic > 0) {
        ++scene_.not_modelled["clear_coats"];
        scene_.warnings.push_back(
            fmt::format("material \"{}\": the clear coat on its metal is ignored", material.name));
      } else {
        // There is one lobe: that of the coat, which is the smoother of the two.
        part.roughness = std::min(part.roughness, roughness * roughness);
        gloss = gloss.max(coat * normal_reflectance(1.5));
      }
    }
    if (!(gloss > 0).any()) return;
    const double left = 1 - gloss.maxCoeff();
    material.reflectance *= left;
    if (part.diffuse_transmittance.size() > 0) part.diffuse_transmittance *= left;
    part.specular_reflectance =
        part.specular_reflectance.size() > 0 ? Rgb(part.specular_reflectance + gloss) : gloss;
    part.angle_law = AngleLaw::kSchlick;
  }

  /// Without a thickness the surface is a thin pane.
  void read_volume(const tinygltf::Material& source, NonDiffusePart& part) const {
    constexpr double kMost = 1e30;
    part.is_solid = number(source, kVolume, "thicknessFactor", 0, kMost) > 0;
    const double distance = number(source, kVolume, "attenuationDistance", kMost, kMost);
    const Rgb colour = triple(source, kVolume, "attenuationColor");
    if (!part.is_solid || !(distance < kMost) || !(colour < 1).any()) return;
    if (!(distance > 0) || !(colour > 0).all())
      fail(in_extension(kVolume, distance > 0 ? "attenuationColor" : "attenuationDistance"),
           "glass that lets nothing through", "Give more than 0.");
    part.absorption_per_m = -colour.log() / distance;
  }

  void read_specular_glossiness(const tinygltf::Material& source, Material& material) {
    const tinygltf::Value& object = extension(source, kSpecularGlossiness);
    Rgb diffuse = triple(source, kSpecularGlossiness, "diffuseFactor");
    if (object.Has("diffuseTexture")) {
      const tinygltf::Value& texture = object.Get("diffuseTexture");
      const bool indexed = texture.IsObject() && texture.Has("index") && texture.Get("index").IsInt();
      if (!indexed)
        fail(in_extension(kSpecularGlossiness, "diffuseTexture"), "diffuseTexture has no index",
             "Export the file anew.");
      diffuse *=
          mean(texture.Get("index").GetNumberAsInt(), TextureEncoding::kSrgb, "diffuse", material.name);
    }
    // Less what is reflected before it comes to the diffuse part, by the definition of the extension.
    const Rgb specular = triple(source, kSpecularGlossiness, "specularFactor");
    material.reflectance = diffuse * (1 - specular.maxCoeff());
    if ((specular > 0).any()) {
      material.non_diffuse.specular_reflectance = specular;
      material.non_diffuse.angle_law = AngleLaw::kSchlick;
    }
    const double roughness = 1 - number(source, kSpecularGlossiness, "glossinessFactor", 1, 1);
    material.non_diffuse.roughness = roughness * roughness;
  }

  void read_emission(const tinygltf::Material& source, Material& material) {
    constexpr double kMostStrength = 1e30;  // before units; the limits of a room apply to the radiance
    constexpr const char* kStrength = "KHR_materials_emissive_strength";
    material.emitted_radiance = Rgb::Zero();
    if (source.emissiveFactor.empty()) return;
    const double strength = number(source, kStrength, "emissiveStrength", 1, kMostStrength);
    const Rgb factor = rgb(source.emissiveFactor, kMostStrength, "emissiveFactor") * strength;
    if (!(factor > 0).any()) return;
    const Rgb emissive =
        factor * mean(source.emissiveTexture.index, TextureEncoding::kSrgb, "emissive", material.name);
    material.emitted_radiance = emissive * units_.radiance();
    const std::string problem = strength_problem(material.emitted_radiance, "the radiance [W/(m2 sr)]");
    if (!problem.empty())
      fail(strength == 1 ? "emissiveFactor" : in_extension(kStrength, "emissiveStrength"), problem,
           kStrengthAdvice);
    material.emits_both_sides = source.doubleSided;
  }

  Material read(const tinygltf::Material& source) {
    Material material;
    material.name = source.name;
    material.two_sided = source.doubleSided;
    if (extension(source, kSpecularGlossiness).IsObject()) {
      read_specular_glossiness(source, material);
    } else {
      read_metallic_roughness(source, material);
    }
    read_emission(source, material);
    if (source.alphaMode != "OPAQUE") {
      ++scene_.not_modelled["transparent_materials"];
      scene_.warnings.push_back(
          fmt::format("material \"{}\": alpha mode {} is ignored, the surface is opaque", material.name,
                      source.alphaMode == "MASK" ? "MASK" : "BLEND"));
    }
    return material;
  }

  const GltfModel& gltf_;
  GltfTextures textures_;
  const GltfUnits& units_;
  Scene& scene_;
  std::string where_;  // JSON pointer of the material
};

}  // namespace

void read_gltf_materials(const GltfModel& gltf, const GltfAccessors& accessors, const GltfUnits& units,
                         Scene& scene) {
  MaterialReader(gltf, accessors, units, scene).read_all();
  Material plain;
  plain.name = "no material";
  constexpr double kPlainReflectance = 0.5;
  plain.reflectance = Rgb::Constant(kPlainReflectance);
  plain.emitted_radiance = Rgb::Zero();
  scene.materials.push_back(std::move(plain));
}

}  // namespace reemit
