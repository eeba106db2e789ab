#pragma once
#include <filesystem>
#include <memory>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/common/texture_images.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Reads the textures of the materials of a room file (docs/room_format.md).
class NativeTextures {
 public:
  /// Image files are named relative to `folder`.
  NativeTextures(std::filesystem::path folder, Scene& scene) : folder_(std::move(folder)), scene_(scene) {}

  /// "texture", "emission_texture", "opacity", "opacity_texture" and "opacity_cutoff" of a material whose
  /// reflectance and emission are those where the images are white; they become the means. Throws InputError
  /// with the place of what is wrong, an image that cannot be read among it.
  void read(const JsonCursor& at, Material& material);

 private:
  Texture read_texture(const JsonCursor& at, TextureEncoding encoding);
  Spectrum mean_of(const Texture& texture) const;
  /// Those of texels; none unless the room has spectral bands.
  TexelSpectra spectra();

  std::filesystem::path folder_;
  Scene& scene_;
  TextureImages images_;
  std::shared_ptr<const ColourSpectra> spectra_;  // once they are needed
};

}  // namespace reemit
