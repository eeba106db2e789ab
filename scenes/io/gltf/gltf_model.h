#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace reemit {

/// What to do about compressed geometry that cannot be decoded.
inline constexpr const char* kDamagedAdvice = "The file is damaged; export it anew.";

inline constexpr std::uintmax_t kLargestGltf = std::uintmax_t{2}
                                               << 30;  ///< The parser counts bytes in 32 bits.

/// A parsed glTF file whose images are still encoded: tinygltf::Image::image holds the bytes of the image
/// file, or nothing where they lie in a buffer view or could not be found.
struct GltfModel {
  tinygltf::Model model;
  std::string file;                   ///< For messages.
  std::vector<std::string> warnings;  ///< Of the parser.

  /// File and JSON pointer, as messages show them: at("/materials/3") is room.gltf#/materials/3.
  std::string at(const std::string& pointer) const { return file + "#" + pointer; }
};

/// Parses a .gltf or .glb file with its buffers; compressed geometry is decoded. Throws InputError for a file
/// that is cut off, chunks that do not fit, malformed JSON, missing buffers, another version than 2 and
/// required extensions that are not supported.
GltfModel load_gltf_model(const std::filesystem::path& file);

}  // namespace reemit
