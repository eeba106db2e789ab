#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace reemit {

/// What lies beyond the edges of an image.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// Red, green, blue and opacity of a texel, linear.
using Texel = std::array<float, 4>;

/// A copy of an image with fewer texels, each the mean over the part of the image that it covers.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<Texel> texels;  ///< [y * width + x], from the upper left corner.
};

/// An image as light meets it: linear values, with ever smaller copies down to one texel, its mean. Does not
/// change once it is made (make_texture_image).
struct TextureImage {
  std::string source;                   ///< Where it was read from, for messages and `info`.
  int width = 0, height = 0;            ///< [texels]
  int read_width = 0, read_height = 0;  ///< As in the file; larger where that is too much to keep.
  std::vector<std::uint8_t> bytes;      ///< [4 * (y * width + x) + channel], or none:
  std::vector<Texel> texels;            ///< of images of floating point.
  std::array<float, 256> decoded{};     ///< Linear value of a byte of red, green or blue.
  std::vector<TextureLevel> levels;     ///< Each about half as wide and high as the one before.
  Texel mean{}, largest{};              ///< Over all texels.
  float smallest_opacity = 1;
  bool is_grey = true;       ///< Red, green and blue are equal everywhere.
  bool has_opacity = false;  ///< The file had such a channel.
  std::uint64_t hash = 0;    ///< Of its size and texels.

  Texel texel(int x, int y) const {
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    if (bytes.empty()) return texels[i];
    const std::uint8_t* b = &bytes[4 * i];
    return {decoded[b[0]], decoded[b[1]], decoded[b[2]], static_cast<float>(b[3]) / 255.0F};
  }
  std::size_t memory() const;  ///< [byte]
};

/// Completes an image of which source, size and texels are given: levels, means and hash.
void finish_texture_image(TextureImage& image);

/// An image on a surface.
struct Texture {
  std::shared_ptr<const TextureImage> image;  ///< Null: there is none.
  unsigned set = 0;                           ///< Of the coordinates of a TexturePoint.
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  bool nearest = false;  ///< Texels are squares of one value; else values between them are interpolated.
  /// (u, v, 1) of the surface to the image: (0, 0) is its upper left corner, (1, 1) its lower right one.
  Eigen::Matrix<double, 2, 3> to_image = Eigen::Matrix<double, 2, 3>::Identity();

  explicit operator bool() const { return image != nullptr; }
};

/// What corners of faces carry besides their place.
struct TexturePoint {
  static constexpr unsigned kSets = 2;
  std::array<std::array<double, 2>, kSets> uv{};  ///< Texture coordinates, by set.
  std::array<float, 3> colour{1, 1, 1};           ///< Linear Rec.709 factor of the reflectance [0,1].

  bool operator==(const TexturePoint&) const = default;
};

}  // namespace reemit
