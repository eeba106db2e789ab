#include "scenes/io/gltf/gltf_texture.h"

#include <array>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "scenes/io/common/srgb.h"
#include "scenes/model/error.h"

namespace reemit {

namespace {

constexpr int kMostTexels = 16384;  // Per side.

/// The decoded value of each 8-bit level.
std::array<double, 256> levels(TextureEncoding encoding) {
  std::array<double, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    table[i] = encoding == TextureEncoding::kSrgb ? linear_from_srgb(value) : value;
  }
  return table;
}

/// The extension that tells OpenImageIO which decoder to use; glTF images are PNG or JPEG, with WebP by
/// extension.
const char* extension_of(const unsigned char* bytes, std::size_t size) {
  if (size >= 4 && bytes[0] == 0x89 && bytes[1] == 'P') return "image.png";
  if (size >= 4 && bytes[0] == 0xFF && bytes[1] == 0xD8) return "image.jpg";
  if (size >= 12 && bytes[0] == 'R' && bytes[1] == 'I' && bytes[8] == 'W') return "image.webp";
  return nullptr;
}

std::optional<Eigen::Array3d> mean_of_image(const unsigned char* bytes, std::size_t size,
                                            TextureEncoding encoding) {
  const char* name = extension_of(bytes, size);
  if (!name) return std::nullopt;
  OIIO::Filesystem::IOMemReader memory(bytes, size);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(name, nullptr, &memory);
  if (!input) {
    OIIO::geterror();  // Clears the message, which would otherwise surface elsewhere.
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMostTexels || spec.height > kMostTexels ||
      spec.nchannels < 1 || spec.nchannels > 4) {
    return std::nullopt;
  }
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::array<double, 256> table = levels(encoding);
  std::vector<unsigned char> row(static_cast<std::size_t>(spec.width) * channels);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int y = 0; y < spec.height; ++y) {
    if (!input->read_scanline(y + spec.y, 0, OIIO::TypeDesc::UINT8, row.data())) {
      input->geterror();
      return std::nullopt;
    }
    for (std::size_t x = 0; x < row.size(); x += channels) {
      // One or two channels are grey, with alpha.
      const bool grey = channels < 3;
      sum += Eigen::Array3d(table[row[x]], table[row[grey ? x : x + 1]], table[row[grey ? x : x + 2]]);
    }
  }
  return sum / (static_cast<double>(spec.width) * spec.height);
}

}  // namespace

std::optional<Eigen::Array3d> GltfTextures::mean(int texture, TextureEncoding encoding,
                                                 const std::string& where) {
  const tinygltf::Model& model = gltf_.model;
  if (texture < 0 || static_cast<std::size_t>(texture) >= model.textures.size()) {
    throw InputError(gltf_.at(where), fmt::format("there is no texture {}", texture),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  }
  const int source = model.textures[static_cast<std::size_t>(texture)].source;
  if (source < 0) return std::nullopt;  // Given by an extension only.
  if (static_cast<std::size_t>(source) >= model.images.size()) {
    throw InputError(gltf_.at(fmt::format("/textures/{}/source", texture)),
                     fmt::format("there is no image {}", source),
                     "Check the file with the Khronos glTF validator, or export it anew.");
  }
  const auto key = std::make_pair(source, encoding);
  if (const auto it = known_.find(key); it != known_.end()) return it->second;
  const tinygltf::Image& image = model.images[static_cast<std::size_t>(source)];
  const auto [bytes, size] = image.bufferView >= 0
                                 ? accessors_.view_bytes(image.bufferView, fmt::format("/images/{}", source))
                                 : std::make_pair(image.image.data(), image.image.size());
  return known_[key] = mean_of_image(bytes, size, encoding);
}

}  // namespace reemit
