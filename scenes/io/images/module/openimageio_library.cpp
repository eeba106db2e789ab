// Image files by OpenImageIO. The one file of the module: it shares headers with the rest, but no code.
#include <algorithm>
#include <exception>
#include <string_view>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "scenes/io/images/image_library.h"

#include "reemit/version.h"

namespace reemit {
namespace {

OIIO::TypeDesc type_of(PixelType type) {
  return type == PixelType::kByte ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT;
}

class OpenImage final : public ImageReader {
 public:
  explicit OpenImage(std::unique_ptr<OIIO::ImageInput> input) : input_(std::move(input)) {}
  /// Of an image in memory, from which `input` reads.
  OpenImage(std::unique_ptr<OIIO::ImageInput> input, std::unique_ptr<OIIO::Filesystem::IOProxy> memory)
      : memory_(std::move(memory)), input_(std::move(input)) {}

  ImageLayout layout() const override {
    const OIIO::ImageSpec& spec = input_->spec();
    return {spec.width, spec.height, spec.nchannels, spec.format.is_floating_point(),
            std::max(1, spec.tile_height)};
  }
  bool read_rows(int begin, int end, PixelType type, void* values) override {
    const OIIO::ImageSpec& spec = input_->spec();
    // read_scanlines sets 64 MB aside at every call, and divides by 0 where the image is in tiles.
    if (spec.tile_height == 0) return input_->read_scanline(spec.y + begin, spec.z, type_of(type), values);
    return input_->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end, spec.z,
                              spec.z + 1, 0, spec.nchannels, type_of(type), values);
  }
  std::string take_message() override { return input_->geterror(); }

 private:
  std::unique_ptr<OIIO::Filesystem::IOProxy> memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

/// Encoders know failure only as a short count, and some ignore it when they close; so the first error is
/// kept and thrown by check().
class SinkProxy final : public OIIO::Filesystem::IOProxy {
 public:
  explicit SinkProxy(ByteSink& sink) : IOProxy("", Write), sink_(sink) {}

  const char* proxytype() const override { return "reemit byte sink"; }
  std::size_t write(const void* bytes, std::size_t size) override {
    const std::size_t written = pwrite(bytes, size, m_pos);
    m_pos += static_cast<std::int64_t>(written);
    return written;
  }
  std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t offset) override {
    if (error_) return 0;
    const auto begin = static_cast<std::uint64_t>(offset);
    try {
      sink_.write_at(begin, bytes, size);
    } catch (...) {  // called from C code that an exception must not cross
      error_ = std::current_exception();
      return 0;
    }
    size_ = std::max(size_, static_cast<std::size_t>(begin + size));
    return size;
  }
  std::size_t size() const override { return size_; }

  void check() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  ByteSink& sink_;
  std::size_t size_ = 0;
  std::exception_ptr error_;
};

OIIO::ImageSpec spec_of(const ImageDescription& description) {
  OIIO::ImageSpec spec(description.width, description.height, static_cast<int>(description.channels.size()),
                       type_of(description.type));
  spec.channelnames = description.channels;
  return spec;
}

class OpenImageIoLibrary final : public ImageLibrary {
 public:
  OpenedImage open(const std::string& file) const override {
    const OIIO::ImageSpec config = reading_config();
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &config);
    if (!input) return unopened();
    return {std::make_unique<OpenImage>(std::move(input)), ""};
  }
  OpenedImage open(const std::string& kind, const unsigned char* bytes, std::size_t size) const override {
    auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, size);
    OIIO::ImageSpec config = reading_config();
    OIIO::Filesystem::IOProxy* proxy = memory.get();  // with a configuration, only that is asked for it
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(kind, &config, proxy);
    if (!input) return unopened();
    return {std::make_unique<OpenImage>(std::move(input), std::move(memory)), ""};
  }
  std::string encode(const ImageDescription& description, const void* pixels, ByteSink& sink) const override {
    SinkProxy proxy(sink);
    const std::string error = encode(description, pixels, proxy);
    proxy.check();
    return error;
  }

 private:
  static OIIO::ImageSpec reading_config() {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
  }
  /// Clears the message, so that it does not surface elsewhere.
  static OpenedImage unopened() { return {nullptr, OIIO::geterror()}; }
  static std::string encode(const ImageDescription& description, const void* pixels,
                            OIIO::Filesystem::IOProxy& proxy) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(description.format, &proxy);
    if (!output) return OIIO::geterror();
    const bool written = output->open("reemit." + description.format, spec_of(description)) &&
                         output->write_image(type_of(description.type), pixels) && output->close();
    return written ? "" : output->geterror();
  }
};

}  // namespace
}  // namespace reemit

extern "C" const reemit::ImageLibrary* reemit_image_library(const char* program_version) {
  static const reemit::OpenImageIoLibrary library;
  return std::string_view(program_version) == reemit::kProgramVersion ? &library : nullptr;
}
