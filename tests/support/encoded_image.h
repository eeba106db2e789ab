#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "scenes/io/images/image_library.h"

namespace reemit::test {

/// What an encoder writes.
class ImageBytes final : public ByteSink {
 public:
  void write_at(std::uint64_t offset, const void* from, std::size_t size) override {
    bytes.resize(std::max<std::size_t>(bytes.size(), offset + size));
    std::memcpy(&bytes[offset], from, size);
  }
  std::string bytes;
};

/// The bytes of an image file; `pixels` as the description has them.
inline std::string encoded_image(const ImageDescription& description, const void* pixels) {
  ImageBytes file;
  const std::string problem = image_library().encode(description, pixels, file);
  if (!problem.empty()) throw std::runtime_error(problem);
  return file.bytes;
}

}  // namespace reemit::test
