#pragma once
#include <string>

#include "scenes/io/common/texture_images.h"
#include "scenes/io/gltf/gltf_accessors.h"
#include "scenes/model/texture.h"

namespace reemit {

/// A texture of a material, or why there is none.
struct GltfTextureRead {
  Texture texture;
  std::string problem;  ///< Empty: texture is valid.
};

/// The textures of a glTF file with their images, samplers and transforms (KHR_texture_transform).
class GltfTextures {
 public:
  GltfTextures(const GltfModel& gltf, const GltfAccessors& accessors) : gltf_(gltf), accessors_(accessors) {}

  /// The texture that a material refers to; a problem where its image is missing or cannot be decoded. Throws
  /// InputError for a texture, sampler or image that does not exist and transforms that are not numbers.
  /// `where`: JSON pointer of what uses the texture.
  GltfTextureRead read(const tinygltf::TextureInfo& use, TextureEncoding encoding, const std::string& where);

 private:
  void read_sampler(int sampler, const std::string& where, Texture& texture) const;
  void read_transform(const tinygltf::TextureInfo& use, const std::string& where, int& set,
                      Texture& texture) const;

  const GltfModel& gltf_;
  const GltfAccessors& accessors_;
  TextureImages images_;
};

}  // namespace reemit
