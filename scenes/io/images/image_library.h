#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace reemit {

/// How a buffer holds a value of a pixel: a byte, where 255 is 1, or a float.
enum class PixelType { kByte, kFloat };

struct ImageLayout {
  int width = 0, height = 0, channels = 0;
  bool is_float = false;  ///< Values of the file are of floating point, not whole numbers.
  int rows_together = 1;  ///< Of a tile; 1 where the image is not in tiles.
};

/// An image file that is open. Colours are as the file has them, not multiplied by opacity.
class ImageReader {
 public:
  virtual ~ImageReader() = default;
  virtual ImageLayout layout() const = 0;
  /// Rows [begin, end) from the top, all channels of a pixel together: one row, or those of a row of tiles,
  /// which begins at a multiple of rows_together. False if the file ends early or is damaged.
  virtual bool read_rows(int begin, int end, PixelType type, void* values) = 0;
  /// What the decoder has said since it was last asked; it may tell of what is harmless.
  virtual std::string take_message() = 0;
};

/// An image that is open, or why it is not.
struct OpenedImage {
  std::unique_ptr<ImageReader> reader;  ///< Null: see `problem`.
  std::string problem;
};

/// An image to write. Its pixels hold channels.size() values of `type` each, rows from the top.
struct ImageDescription {
  std::string format;  ///< As the library calls it: "png", "openexr", "hdr".
  int width = 0, height = 0;
  std::vector<std::string> channels;
  PixelType type = PixelType::kFloat;
};

/// Where the bytes of an encoded image go.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write_at(std::uint64_t offset, const void* bytes, std::size_t size) = 0;
};

/// The library that reads image files, and writes what no smaller library does. It needs some 260 others,
/// which take a quarter of a second and 120 MB to load, so it is a module that is loaded when first needed.
class ImageLibrary {
 public:
  virtual ~ImageLibrary() = default;
  virtual OpenedImage open(const std::string& file) const = 0;
  /// An image in memory, which must outlive the reader. `kind`: a file name whose extension tells the format.
  virtual OpenedImage open(const std::string& kind, const unsigned char* bytes, std::size_t size) const = 0;
  /// Empty if all went well, else what the library says. What `sink` throws is passed on.
  virtual std::string encode(const ImageDescription& description, const void* pixels,
                             ByteSink& sink) const = 0;
};

/// Loads the module when first called, from any thread. It is looked for where the program was linked to look
/// (its run path), then where the system has its libraries. Throws ResourceError if it is not there or of
/// another version.
const ImageLibrary& image_library();

/// The one function of the module, for its C name below: null unless it is of this version of reemit.
using ImageLibraryFunction = const ImageLibrary* (*)(const char* program_version);
inline constexpr const char* kImageLibraryFunction = "reemit_image_library";

}  // namespace reemit
