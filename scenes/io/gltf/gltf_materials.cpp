#include "scenes/io/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/io/gltf/gltf_texture.h"
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
constexpr const char* kUnlit = "KHR_materials_unlit";

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
    std::size_t unlit = 0;
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
                                                 kUnlit,
                                                 kSpecularGlossiness,
                                                 kDiffuseTransmission};
        if (!known.contains(name)) ignored.insert(name);
      }
      if (source.extensions.contains(kUnlit)) ++unlit;
    }
    if (unlit > 0)
      scene_.warnings.push_back(fmt::format(
          "{} material(s) are unlit (KHR_materials_unlit): their colours, which viewers show as they are, "
          "count as diffuse reflectance",
          unlit));
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

  static Rgb mean_of(const Texture& texture) {
    if (!texture) return Rgb::Ones();
    const Texel& mean = texture.image->mean;
    return Rgb(mean[0], mean[1], mean[2]);
  }

  /// A texture, null where there is none or it cannot be read, with a warning.
  Texture texture(const tinygltf::TextureInfo& use, TextureEncoding encoding, const std::string& pointer,
                  const char* what, const std::string& name) {
    if (use.index < 0) return {};
    GltfTextureRead read = textures_.read(use, encoding, where_ + "/" + pointer);
    if (!read.problem.empty()) {
      ++scene_.refused["textures"];
      scene_.warnings.push_back(
          fmt::format("material \"{}\": its {} texture counts as white: {}", name, what, read.problem));
      return {};
    }
    if (const std::string note = reduction_note(*read.texture.image);
        !note.empty() && reduced_.insert(note).second)
      scene_.notes.push_back(note);
    return std::move(read.texture);
  }

  /// Of textures that count with their means, colour and opacity: 1 where there is none or it cannot be read;
  /// warns in both cases where there is one.
  Eigen::Array4d mean(const tinygltf::TextureInfo& use, TextureEncoding encoding, const std::string& pointer,
                      const char* what, const std::string& name) {
    const Texture read = texture(use, encoding, pointer, what, name);
    if (!read) return Eigen::Array4d::Ones();
    const Texel& value = read.image->mean;
    ++scene_.not_modelled["textures"];
    scene_.warnings.push_back(
        fmt::format("material \"{}\": its {} texture is replaced by its mean {:.3f} {:.3f} {:.3f}{}", name,
                    what, value[0], value[1], value[2],
                    read.image->has_opacity ? fmt::format(" and {:.3f} of opacity", value[3]) : ""));
    return {value[0], value[1], value[2], value[3]};
  }

  /// Of a texture of an extension.
  Eigen::Array4d mean_in(const tinygltf::Material& source, const char* extension_name, const char* key,
                         TextureEncoding encoding, const char* what, const std::string& name) {
    return mean(texture_info(extension(source, extension_name), extension_name, key), encoding,
                in_extension(extension_name, key), what, name);
  }

  /// A texture that an extension refers to.
  tinygltf::TextureInfo texture_info(const tinygltf::Value& object, const char* extension_name,
                                     const char* key) const {
    tinygltf::TextureInfo use;
    if (!object.IsObject() || !object.Has(key)) return use;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsObject() || !value.Has("index") || !value.Get("index").IsInt())
      fail(in_extension(extension_name, key), fmt::format("{} has no index", key), "Export the file anew.");
    use.index = value.Get("index").GetNumberAsInt();
    if (value.Has("texCoord") && value.Get("texCoord").IsInt())
      use.texCoord = value.Get("texCoord").GetNumberAsInt();
    if (value.Has("extensions") && value.Get("extensions").Has("KHR_texture_transform"))
      use.extensions["KHR_texture_transform"] = value.Get("extensions").Get("KHR_texture_transform");
    return use;
  }

  /// The reflectance was read without its texture: now it becomes the mean.
  static void vary_reflectance(Texture texture, Material& material) {
    if (!texture) return;
    material.textures.reflectance_factor = material.reflectance;
    material.reflectance *= mean_of(texture);
    material.textures.reflectance = std::move(texture);
  }

  /// What is unlit has a base colour and its opacity; all else of the model of light means nothing.
  void read_unlit(const tinygltf::Material& source, Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const std::string within = "pbrMetallicRoughness/";
    material.reflectance = rgb(pbr.baseColorFactor, 1, within + "baseColorFactor");
    Texture colour = texture(pbr.baseColorTexture, TextureEncoding::kSrgb, within + "baseColorTexture",
                             "base colour", material.name);
    read_opacity(source, pbr.baseColorFactor, colour, material);
    vary_reflectance(std::move(colour), material);
  }

  void read_metallic_roughness(const tinygltf::Material& source, Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const std::string within = "pbrMetallicRoughness/";
    const Rgb factor = rgb(pbr.baseColorFactor, 1, within + "baseColorFactor");
    Texture colour = texture(pbr.baseColorTexture, TextureEncoding::kSrgb, within + "baseColorTexture",
                             "base colour", material.name);
    const Rgb base = factor * mean_of(colour);  // of what does not vary
    // Green holds the roughness, blue the metallic share.
    const Rgb packed = mean(pbr.metallicRoughnessTexture, TextureEncoding::kLinear,
                            within + "metallicRoughnessTexture", "metallic-roughness", material.name)
                           .head<3>();
    const double metallic = checked(pbr.metallicFactor, 1, within + "metallicFactor") * packed[2];
    const double roughness = checked(pbr.roughnessFactor, 1, within + "roughnessFactor") * packed[1];
    material.non_diffuse.roughness = roughness * roughness;  // alpha, by the definition of the format
    double transmitted = number(source, "KHR_materials_transmission", "transmissionFactor", 0, 1);
    if (transmitted > 0)
      transmitted *= mean_in(source, "KHR_materials_transmission", "transmissionTexture",
                             TextureEncoding::kLinear, "transmission", material.name)[0];
    double through = number(source, kDiffuseTransmission, "diffuseTransmissionFactor", 0, 1);
    if (through > 0)
      through *= mean_in(source, kDiffuseTransmission, "diffuseTransmissionTexture", TextureEncoding::kLinear,
                         "diffuse transmission", material.name)[3];
    const double diffuse = (1 - metallic) * (1 - transmitted);
    material.reflectance = factor * (diffuse * (1 - through));
    if (through > 0)
      material.non_diffuse.diffuse_transmittance =
          triple(source, kDiffuseTransmission, "diffuseTransmissionColorFactor") *
          mean_in(source, kDiffuseTransmission, "diffuseTransmissionColorTexture", TextureEncoding::kSrgb,
                  "colour of diffuse transmission", material.name)
              .head<3>() *
          (diffuse * through);
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
    } else {
      add_dielectric_gloss(source, metallic, material);
    }
    if (colour && metallic > 0)
      scene_.warnings.push_back(fmt::format(
          "material \"{}\": its metallic share, {:.3f}, has the mean of the base colour texture everywhere",
          material.name, metallic));
    read_opacity(source, pbr.baseColorFactor, colour, material);
    vary_reflectance(std::move(colour), material);
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
              mean_in(source, kSpecular, "specularColorTexture", TextureEncoding::kSrgb, "specular colour",
                      material.name)
                  .head<3>() *
              normal_reflectance(index_of_refraction(source));
      gloss = gloss.min(1) * (number(source, kSpecular, "specularFactor", 1, 1) *
                              mean_in(source, kSpecular, "specularTexture", TextureEncoding::kLinear,
                                      "specular", material.name)[3]);
      gloss *= (1 - metallic);
    }
    double coat = number(source, kClearCoat, "clearcoatFactor", 0, 1);
    if (coat > 0)
      coat *= mean_in(source, kClearCoat, "clearcoatTexture", TextureEncoding::kLinear, "clear coat",
                      material.name)[0];
    if (coat > 0) {
      const double roughness = number(source, kClearCoat, "clearcoatRoughnessFactor", 0, 1) *
                               mean_in(source, kClearCoat, "clearcoatRoughnessTexture",
                                       TextureEncoding::kLinear, "clear coat roughness", material.name)[1];
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
    const Rgb diffuse = triple(source, kSpecularGlossiness, "diffuseFactor");
    Texture colour =
        texture(texture_info(object, kSpecularGlossiness, "diffuseTexture"), TextureEncoding::kSrgb,
                in_extension(kSpecularGlossiness, "diffuseTexture"), "diffuse", material.name);
    // Less what is reflected before it comes to the diffuse part, by the definition of the extension.
    const Eigen::Array4d gloss = mean_in(source, kSpecularGlossiness, "specularGlossinessTexture",
                                         TextureEncoding::kSrgb, "specular-glossiness", material.name);
    const Rgb specular = triple(source, kSpecularGlossiness, "specularFactor") * gloss.head<3>();
    material.reflectance = diffuse * (1 - specular.maxCoeff());
    if ((specular > 0).any()) {
      material.non_diffuse.specular_reflectance = specular;
      material.non_diffuse.angle_law = AngleLaw::kSchlick;
    }
    const double roughness = 1 - number(source, kSpecularGlossiness, "glossinessFactor", 1, 1) * gloss[3];
    material.non_diffuse.roughness = roughness * roughness;
    std::vector<double> factor{1, 1, 1, 1};
    if (object.Has("diffuseFactor") && object.Get("diffuseFactor").ArrayLen() > 3)
      factor[3] = object.Get("diffuseFactor").Get(3).GetNumberAsDouble();
    read_opacity(source, factor, colour, material);
    vary_reflectance(std::move(colour), material);
  }

  /// Alpha modes MASK and BLEND; `factor`: of the base colour, with its opacity.
  void read_opacity(const tinygltf::Material& source, const std::vector<double>& factor,
                    const Texture& colour, Material& material) const {
    if (source.alphaMode != "MASK" && source.alphaMode != "BLEND") return;
    MaterialTextures& textures = material.textures;
    textures.opacity_factor =
        factor.size() > 3 ? checked(factor[3], 1, "pbrMetallicRoughness/baseColorFactor") : 1;
    if (colour && colour.image->has_opacity && colour.image->smallest_opacity < 1) textures.opacity = colour;
    if (source.alphaMode == "BLEND") return;
    const double cutoff = checked(source.alphaCutoff, 1e6, "alphaCutoff");
    if (textures.opacity)
      textures.opacity_cutoff = cutoff;
    else
      textures.opacity_factor = textures.opacity_factor >= cutoff ? 1 : 0;
  }

  void read_emission(const tinygltf::Material& source, Material& material) {
    constexpr double kMostStrength = 1e30;  // before units; the limits of a room apply to the radiance
    constexpr const char* kStrength = "KHR_materials_emissive_strength";
    material.emitted_radiance = Rgb::Zero();
    if (source.emissiveFactor.empty()) return;
    const double strength = number(source, kStrength, "emissiveStrength", 1, kMostStrength);
    const Rgb factor = rgb(source.emissiveFactor, kMostStrength, "emissiveFactor") * strength;
    if (!(factor > 0).any()) return;
    Texture image =
        texture(source.emissiveTexture, TextureEncoding::kSrgb, "emissiveTexture", "emissive", material.name);
    const Rgb strongest = factor * units_.radiance();
    material.emitted_radiance = strongest * mean_of(image);
    if (image) {
      material.textures.emission_factor = strongest;
      material.textures.emission = std::move(image);
    }
    const std::string problem = strength_problem(Spectrum(strongest), "the radiance [W/(m2 sr)]");
    if (!problem.empty())
      fail(strength == 1 ? "emissiveFactor" : in_extension(kStrength, "emissiveStrength"), problem,
           kStrengthAdvice);
    material.emits_both_sides = source.doubleSided;
  }

  Material read(const tinygltf::Material& source) {
    Material material;
    material.name = source.name;
    material.two_sided = source.doubleSided;
    if (source.extensions.contains(kUnlit)) {
      read_unlit(source, material);
    } else if (extension(source, kSpecularGlossiness).IsObject()) {
      read_specular_glossiness(source, material);
    } else {
      read_metallic_roughness(source, material);
    }
    read_emission(source, material);
    if (source.normalTexture.index >= 0) ++scene_.not_modelled["normal_maps"];
    return material;
  }

  const GltfModel& gltf_;
  GltfTextures textures_;
  const GltfUnits& units_;
  Scene& scene_;
  std::set<std::string> reduced_;  // images, as told
  std::string where_;              // JSON pointer of the material
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
