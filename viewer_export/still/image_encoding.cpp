#include "viewer_export/still/image_encoding.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "scenes/model/error.h"

namespace reemit {
namespace {

class FileSink final : public ByteSink {
 public:
  explicit FileSink(OutputFile& file) : file_(file) {}
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size) override {
    file_.write_at(offset, bytes, size);
  }

 private:
  OutputFile& file_;
};

class MemorySink final : public ByteSink {
 public:
  explicit MemorySink(std::string& memory) : memory_(memory) {}
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size) override {
    memory_.resize(std::max(memory_.size(), offset + size));
    std::memcpy(memory_.data() + offset, bytes, size);
  }

 private:
  std::string& memory_;
};

void encode_into(ByteSink& sink, const ImageDescription& description, const void* pixels) {
  const std::string error = image_library().encode(description, pixels, sink);
  if (error.empty()) return;
  throw ResourceError(description.format + " image", "OpenImageIO cannot write it: " + error,
                      "Check that OpenImageIO was built with this format.");
}

}  // namespace

ImageDescription sized_as(const StillImage& image, std::string_view format, PixelType type,
                          std::vector<std::string> channels) {
  return {std::string(format), image.width, image.height, std::move(channels), type, {}};
}

std::vector<std::pair<std::string, std::string>> metadata_of(const StillImage& image) {
  std::vector<std::pair<std::string, std::string>> metadata{
      {"Software", "reemit " + image.info.program_version}};
  for (auto [name, value] : describe(image.info, image.bands)) {
    std::replace(name.begin(), name.end(), ' ', '_');
    metadata.emplace_back("reemit:" + name, value);
  }
  return metadata;
}

void add_metadata(const StillImage& image, ImageDescription& description) {
  auto& attributes = description.attributes;
  attributes.emplace_back("DateTime", "");  // or the time of writing is added: equal runs give equal files
  for (const auto& [name, value] : metadata_of(image)) attributes.emplace_back(name, value);
}

void encode_image(const ImageDescription& description, const void* pixels, OutputFile& file) {
  FileSink sink(file);
  encode_into(sink, description, pixels);
}

std::string encode_image(const ImageDescription& description, const void* pixels) {
  std::string bytes;
  MemorySink sink(bytes);
  encode_into(sink, description, pixels);
  return bytes;
}

}  // namespace reemit
