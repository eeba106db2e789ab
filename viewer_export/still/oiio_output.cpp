#include "viewer_export/still/oiio_output.h"

#include <algorithm>
#include <exception>
#include <memory>

#include <OpenImageIO/filesystem.h>

#include "scenes/model/error.h"

namespace reemit {
namespace {

// Lets OpenImageIO write into an OutputFile. Its encoders know failure only as a short count, and some ignore
// it when they close; so the first error is kept and thrown by check().
class OutputFileProxy final : public OIIO::Filesystem::IOProxy {
 public:
  explicit OutputFileProxy(OutputFile& file) : IOProxy("", Write), file_(file) {}

  const char* proxytype() const override { return "reemit output file"; }
  std::size_t write(const void* bytes, std::size_t size) override;
  std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t offset) override;
  std::size_t size() const override { return size_; }

  // Throws the ResourceError of the first write that failed.
  void check() const;

 private:
  OutputFile& file_;
  std::size_t size_ = 0;
  std::exception_ptr error_;
};

std::size_t OutputFileProxy::write(const void* bytes, std::size_t size) {
  const std::size_t written = pwrite(bytes, size, m_pos);
  m_pos += static_cast<std::int64_t>(written);
  return written;
}

std::size_t OutputFileProxy::pwrite(const void* bytes, std::size_t size, std::int64_t offset) {
  if (error_) return 0;
  const auto begin = static_cast<std::uint64_t>(offset);
  try {
    file_.write_at(begin, bytes, size);
  } catch (...) {  // called from C code that an exception must not cross
    error_ = std::current_exception();
    return 0;
  }
  size_ = std::max(size_, static_cast<std::size_t>(begin + size));
  return size;
}

void OutputFileProxy::check() const {
  if (error_) std::rethrow_exception(error_);
}

// Empty if all went well, else what OpenImageIO says.
std::string encode(const std::string& format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                   const void* pixels, OIIO::Filesystem::IOProxy& proxy) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format, &proxy);
  if (!output) return OIIO::geterror();
  const bool written =
      output->open("reemit." + format, spec) && output->write_image(type, pixels) && output->close();
  return written ? "" : output->geterror();
}

[[noreturn]] void fail(const std::string& format, const std::string& reason) {
  throw ResourceError(format + " image", "OpenImageIO cannot write it: " + reason,
                      "Check that OpenImageIO was built with this format.");
}

}  // namespace

void describe_image(const StillImage& image, OIIO::ImageSpec& spec) {
  spec.attribute("DateTime", "");  // or the time of writing would be added: equal runs give equal files
  spec.attribute("Software", "reemit " + image.info.program_version);
  for (auto [name, value] : describe(image.info, image.bands)) {
    std::replace(name.begin(), name.end(), ' ', '_');
    spec.attribute("reemit:" + name, value);
  }
}

void encode_image(const std::string& format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                  const void* pixels, OutputFile& file) {
  OutputFileProxy proxy(file);
  const std::string error = encode(format, spec, type, pixels, proxy);
  proxy.check();
  if (!error.empty()) fail(format, error);
}

std::vector<unsigned char> encode_image(const std::string& format, const OIIO::ImageSpec& spec,
                                        const OIIO::TypeDesc& type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::string error = encode(format, spec, type, pixels, memory);
  if (!error.empty()) fail(format, error);
  return bytes;
}

}  // namespace reemit
