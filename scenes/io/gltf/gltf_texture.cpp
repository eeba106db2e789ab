#include "scenes/io/gltf/gltf_texture.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

/// The extension that tells OpenImageIO which decoder to use; glTF images are PNG or JPEG, with WebP by
/// extension.
const char* extension_of(const unsigned char* bytes, std::size_t size) {
  if (size >= 4 && bytes[0] == 0x89 && bytes[1] == 'P') return "image.png";
  if (size >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8) return "image.jpg";
  if (size >= 12 && bytes[0] == 'R' && bytes[1] == 'I' && bytes[8] == 'W') return "image.webp";
  return nullptr;
}

TextureWrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::kClamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::kMirror : TextureWrap::kRepeat;
}

}  // namespace

GltfTextureRead GltfTextures::read(const tinygltf::TextureInfo& use, TextureEncoding encoding,
                                   const std::string& where) {
  const tinygltf::Model& model = gltf_.model;
  if (use.index < 0 || static_cast<std::size_t>(use.index) >= model.textures.size()) {
    throw InputError(gltf_.at(where), fmt::format("there is no texture {}", use.index),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  }
  const tinygltf::Texture& source = model.textures[static_cast<std::size_t>(use.index)];
  if (source.source < 0) return {{}, "its image is given by an extension only"};
  if (static_cast<std::size_t>(source.source) >= model.images.size()) {
    throw InputError(gltf_.at(fmt::format("/textures/{}/source", use.index)),
                     fmt::format("there is no image {}", source.source),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  }
  const tinygltf::Image& image = model.images[static_cast<std::size_t>(source.source)];
  const std::string at_image = fmt::format("/images/{}", source.source);
  const auto [bytes, size] = image.bufferView >= 0 ? accessors_.view_bytes(image.bufferView, at_image)
                                                   : std::make_pair(image.image.data(), image.image.size());
  const std::string name =
      image.uri.empty() ? gltf_.at(at_image) : fmt::format("{} ({})", gltf_.at(at_image), image.uri);
  if (size == 0) return {{}, name + " is missing"};
  const char* kind = extension_of(bytes, size);
  if (kind == nullptr) return {{}, name + " is no PNG, JPEG or WebP image"};
  GltfTextureRead result;
  TextureRead read = images_.from_memory(name, kind, bytes, size, encoding);
  result.texture.image = std::move(read.image);
  result.problem = std::move(read.problem);
  if (!result.problem.empty()) return result;
  read_sampler(source.sampler, where, result.texture);
  int set = use.texCoord;
  read_transform(use, where, set, result.texture);
  if (set < 0 || set >= static_cast<int>(TexturePoint::kSets))
    return {{}, fmt::format("it uses TEXCOORD_{}; the first {} are read", set, TexturePoint::kSets)};
  result.texture.set = static_cast<unsigned>(set);
  return result;
}

void GltfTextures::read_sampler(int sampler, const std::string& where, Texture& texture) const {
  if (sampler < 0) return;
  if (static_cast<std::size_t>(sampler) >= gltf_.model.samplers.size())
    throw InputError(gltf_.at(where), fmt::format("there is no sampler {}", sampler),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  const tinygltf::Sampler& source = gltf_.model.samplers[static_cast<std::size_t>(sampler)];
  texture.wrap_u = wrap_of(source.wrapS);
  texture.wrap_v = wrap_of(source.wrapT);
  texture.nearest = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

void GltfTextures::read_transform(const tinygltf::TextureInfo& use, const std::string& where, int& set,
                                  Texture& texture) const {
  const auto extension = use.extensions.find("KHR_texture_transform");
  if (extension == use.extensions.end() || !extension->second.IsObject()) return;
  const tinygltf::Value& object = extension->second;
  const auto number = [&](const tinygltf::Value& value, const char* key) {
    const double x = value.IsNumber() ? value.GetNumberAsDouble() : NAN;
    constexpr double kMost = 1e6;
    if (!(std::abs(x) <= kMost))
      throw InputError(gltf_.at(fmt::format("{}/extensions/KHR_texture_transform/{}", where, key)),
                       fmt::format("{} is no number in its range", key), "Export the file anew.");
    return x;
  };
  const auto pair = [&](const char* key, double otherwise) {
    Eigen::Vector2d values(otherwise, otherwise);
    if (!object.Has(key)) return values;
    const tinygltf::Value& list = object.Get(key);
    for (int i = 0; i < 2; ++i)
      values[i] = number(list.IsArray() && list.ArrayLen() == 2 ? list.Get(i) : tinygltf::Value(), key);
    return values;
  };
  const Eigen::Vector2d offset = pair("offset", 0);
  const Eigen::Vector2d scale = pair("scale", 1);
  const double angle = object.Has("rotation") ? number(object.Get("rotation"), "rotation") : 0;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  texture.to_image << c * scale.x(), s * scale.y(), offset.x(), -s * scale.x(), c * scale.y(), offset.y();
  if (object.Has("texCoord") && object.Get("texCoord").IsInt()) set = object.Get("texCoord").GetNumberAsInt();
}

}  // namespace reemit
