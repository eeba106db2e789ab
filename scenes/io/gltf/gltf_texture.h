#pragma once
#include <map>
#include <optional>

#include <Eigen/Core>

#include "scenes/io/gltf/gltf_accessors.h"

namespace reemit {

enum class TextureEncoding { kSrgb, kLinear };

/// Mean values of textures: the diffuse solver has one value per material.
class GltfTextures {
 public:
  GltfTextures(const GltfModel& gltf, const GltfAccessors& accessors) : gltf_(gltf), accessors_(accessors) {}

  /// The mean R, G, B [0,1] over all texels, colours decoded to linear light first; nothing if the image is
  /// missing or cannot be decoded. Throws InputError for a texture or image that does not exist.
  /// `where`: JSON pointer of what uses the texture.
  std::optional<Eigen::Array3d> mean(int texture, TextureEncoding encoding, const std::string& where);

 private:
  const GltfModel& gltf_;
  const GltfAccessors& accessors_;
  std::map<std::pair<int, TextureEncoding>, std::optional<Eigen::Array3d>> known_;
};

}  // namespace reemit
