#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scenes/model/texture.h"

namespace reemit {

/// How integer images hold red, green and blue; opacity and images of floating point are linear always.
enum class TextureEncoding { kSrgb, kLinear };

/// An image, or why there is none.
struct TextureRead {
  std::shared_ptr<const TextureImage> image;
  std::string problem;  ///< Empty: image is valid.
};

/// The texture images of a room, each read once, within a bound on their memory: an image has at most 2^24
/// texels, and no more than a quarter of what is left of 2^27 for all. Larger ones are averaged down in
/// linear light. Images have 1 (grey), 2 (grey and opacity), 3 or 4 channels; values are clamped to 0 from
/// below, those of integer images lie in [0,1].
class TextureImages {
 public:
  TextureRead from_file(const std::filesystem::path& file, TextureEncoding encoding);
  /// `bytes` of an image file; `name`: identifies it, for messages; `kind`: a file name whose extension tells
  /// the format.
  TextureRead from_memory(const std::string& name, const std::string& kind, const unsigned char* bytes,
                          std::size_t size, TextureEncoding encoding);

 private:
  using Key = std::pair<std::string, TextureEncoding>;

  std::map<Key, TextureRead> known_;
  double texels_left_ = 1 << 27;
};

/// What to tell of an image that is kept with fewer texels than its file has; empty for others.
std::string reduction_note(const TextureImage& image);

}  // namespace reemit
