#include "viewer_export/still/exr_writer.h"

#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "viewer_export/still/picture_metadata.h"

namespace reemit {
namespace {

constexpr float kWhiteLuminance = 179;  // [cd/m2] of R = G = B = 1 W/(m2 sr)

// One channel of the file: values[pixel * stride + offset] of a layer.
struct Channel {
  std::string name;
  const float* values;
  std::size_t stride;
  std::size_t offset;
};

// As EXR viewers expect them: colour in R G B, a single value in Y, else the wavelength.
std::string channel_name(const BandSet& bands, std::size_t band) {
  switch (bands.kind()) {
    case BandKind::kGrey:
      return "Y";
    case BandKind::kRgb:
      return std::string(1, "RGB"[band]);
    case BandKind::kSpectral:
      break;
  }
  return bands.name(band) + "nm";
}

std::vector<Channel> channels_of(const StillImage& image, std::span<const float> rgb) {
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < 3; ++c) channels.push_back({std::string(1, "RGB"[c]), rgb.data(), 3, c});
  const std::size_t bands = image.bands.count();
  const auto add_bands = [&](const std::string& layer, const std::vector<float>& values) {
    if (values.empty()) return;
    for (std::size_t band = 0; band < bands; ++band)
      channels.push_back({layer + "." + channel_name(image.bands, band), values.data(), bands, band});
  };
  if (image.bands.kind() != BandKind::kRgb) add_bands("radiance", image.radiance);
  add_bands("direct", image.direct);
  add_bands("indirect", image.indirect);
  add_bands("caustic", image.caustic);
  add_bands("stderr", image.radiance_stderr);
  add_bands("albedo", image.albedo);
  if (!image.samples.empty()) channels.push_back({"samples.Y", image.samples.data(), 1, 0});
  if (!image.depth.empty()) channels.push_back({"depth.Z", image.depth.data(), 1, 0});
  if (!image.normal.empty())
    for (std::size_t c = 0; c < 3; ++c)
      channels.push_back({"normal." + std::string(1, "XYZ"[c]), image.normal.data(), 3, c});
  return channels;
}

/// Where the bytes go. OpenEXR ignores what is thrown when it closes a file, so the first error is kept.
class ExrStream final : public Imf::OStream {
 public:
  explicit ExrStream(OutputFile& file) : OStream("picture"), file_(file) {}
  void write(const char* bytes, int size) override {
    try {
      file_.write_at(at_, bytes, static_cast<std::size_t>(size));
    } catch (...) {
      if (!error_) error_ = std::current_exception();
      throw;
    }
    at_ += static_cast<std::uint64_t>(size);
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

  void check() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  OutputFile& file_;
  std::uint64_t at_ = 0;
  std::exception_ptr error_;
};

/// As many as the task arena that asks has; OpenEXR has one pool of its own for the whole program.
int compression_threads() {
  const int threads = tbb::this_task_arena::max_concurrency();
  if (Imf::globalThreadCount() != threads) Imf::setGlobalThreadCount(threads);
  return threads;
}

}  // namespace

void write_exr(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
               OutputFile& file) {
  Imf::Header header(image.width, image.height);
  header.compression() = image.interrupted ? Imf::NO_COMPRESSION : Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());  // those of Rec.709
  Imf::addWhiteLuminance(header, kWhiteLuminance);
  for (const auto& [name, value] : metadata_of(image)) header.insert(name, Imf::StringAttribute(value));
  header.insert("reemit:suggested_display", Imf::StringAttribute(tone_map.statement()));

  Imf::FrameBuffer layers;
  for (const Channel& channel : channels_of(image, rgb)) {
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    const std::size_t pixel = channel.stride * sizeof(float);
    // OpenEXR only reads what it is given.
    char* const values = reinterpret_cast<char*>(const_cast<float*>(channel.values + channel.offset));
    layers.insert(channel.name,
                  Imf::Slice(Imf::FLOAT, values, pixel, pixel * static_cast<std::size_t>(image.width)));
  }
  ExrStream stream(file);
  try {
    Imf::OutputFile output(stream, header, compression_threads());
    output.setFrameBuffer(layers);
    output.writePixels(image.height);
  } catch (const Iex::BaseExc& e) {
    stream.check();
    throw ResourceError("EXR image", fmt::format("OpenEXR cannot write it: {}", e.what()),
                        "Write .hdr instead, or a smaller picture.");
  }
  stream.check();
}

}  // namespace reemit
