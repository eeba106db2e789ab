#include "scenes/io/common/texture_images.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "scenes/io/common/srgb.h"
#include "scenes/io/common/text_file.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr double kMostTexels = 1 << 24;
constexpr double kLeastTexels = 1 << 12;
constexpr int kLongestSide = 65536;
constexpr double kMostRead = 1U << 30;  // texels of a file
constexpr float kBrightest = 1e6F;      // of images of floating point

std::array<float, 256> decoding_table(TextureEncoding encoding) {
  std::array<float, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255;
    table[i] = static_cast<float>(encoding == TextureEncoding::kSrgb ? linear_from_srgb(value) : value);
  }
  return table;
}

/// Reads one image row by row, averaging blocks of `step` x `step` texels.
class ImageReading {
 public:
  ImageReading(OIIO::ImageInput& input, TextureEncoding encoding, double most_texels)
      : input_(input), channels_(static_cast<std::size_t>(input.spec().nchannels)), encoding_(encoding) {
    const OIIO::ImageSpec& spec = input.spec();
    image_.read_width = spec.width;
    image_.read_height = spec.height;
    const auto texels = [&] {
      return std::ceil(1.0 * spec.width / step_) * std::ceil(1.0 * spec.height / step_);
    };
    while (texels() > most_texels) ++step_;
    image_.width = (spec.width + step_ - 1) / step_;
    image_.height = (spec.height + step_ - 1) / step_;
    image_.decoded = decoding_table(encoding);
    image_.has_opacity = channels_ == 2 || channels_ == 4;
    is_float_ = spec.format.is_floating_point();
  }

  /// False if the file ends early or is damaged.
  bool read() {
    return is_float_ ? read_rows<float>(OIIO::TypeDesc::FLOAT)
                     : read_rows<std::uint8_t>(OIIO::TypeDesc::UINT8);
  }
  TextureImage take() { return std::move(image_); }

 private:
  template <class T>
  bool read_rows(const OIIO::TypeDesc& type) {
    const OIIO::ImageSpec& spec = input_.spec();
    const int together = std::max(1, spec.tile_height);
    const std::size_t row_size = static_cast<std::size_t>(spec.width) * channels_;
    std::vector<T> rows(row_size * static_cast<std::size_t>(together));
    std::vector<Texel> sums(static_cast<std::size_t>(image_.width));
    for (int y = 0; y < spec.height; ++y) {
      if (y % together == 0 && !read_from(y, std::min(y + together, spec.height), type, rows.data()))
        return false;
      const std::span row(&rows[row_size * static_cast<std::size_t>(y % together)], row_size);
      if (step_ == 1) {
        for (std::size_t i = 0; i < row.size(); i += channels_) keep(&row[i]);
        continue;
      }
      for (int x = 0; x < spec.width; ++x) {
        const Texel t = linear(&row[static_cast<std::size_t>(x) * channels_]);
        Texel& sum = sums[static_cast<std::size_t>(x / step_)];
        for (std::size_t c = 0; c < 4; ++c) sum[c] += t[c];
      }
      if ((y + 1) % step_ == 0 || y + 1 == spec.height) keep_means(sums, y % step_ + 1);
    }
    return true;
  }

  /// Rows from `begin` on: one, or a row of tiles.
  bool read_from(int begin, int end, const OIIO::TypeDesc& type, void* rows) {
    const OIIO::ImageSpec& spec = input_.spec();
    // read_scanlines sets 64 MB aside at every call.
    if (spec.tile_height == 0) return input_.read_scanline(spec.y + begin, spec.z, type, rows);
    return input_.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end, spec.z,
                             spec.z + 1, 0, static_cast<int>(channels_), type, rows);
  }

  /// Red, green, blue and opacity of what has 1 to 4 channels.
  template <class T>
  std::array<T, 4> spread(const T* v, T whole) const {
    const bool grey = channels_ < 3;
    return {v[0], v[grey ? 0 : 1], v[grey ? 0 : 2], image_.has_opacity ? v[channels_ - 1] : whole};
  }
  Texel linear(const std::uint8_t* v) const {
    const auto b = spread<std::uint8_t>(v, 255);
    return {image_.decoded[b[0]], image_.decoded[b[1]], image_.decoded[b[2]],
            static_cast<float>(b[3]) / 255.0F};
  }
  Texel linear(const float* v) const {
    Texel t = spread<float>(v, 1);
    for (float& x : t) x = x > 0 ? std::min(x, kBrightest) : 0;  // what is no number is 0
    t[3] = std::min(t[3], 1.0F);
    return t;
  }
  void keep(const std::uint8_t* v) {
    const auto b = spread<std::uint8_t>(v, 255);
    image_.bytes.insert(image_.bytes.end(), b.begin(), b.end());
  }
  void keep(const float* v) { image_.texels.push_back(linear(v)); }

  void keep_means(std::vector<Texel>& sums, int rows) {
    for (int x = 0; x < image_.width; ++x) {
      const int columns = std::min(step_, image_.read_width - x * step_);
      Texel& t = sums[static_cast<std::size_t>(x)];
      for (float& v : t) v /= static_cast<float>(rows * columns);
      if (is_float_)
        image_.texels.push_back(t);
      else
        for (std::size_t c = 0; c < 4; ++c) image_.bytes.push_back(encoded(t[c], c));
      t = {};
    }
  }
  std::uint8_t encoded(float linear, std::size_t channel) const {
    const auto v = static_cast<double>(linear);
    const bool srgb = channel < 3 && encoding_ == TextureEncoding::kSrgb;
    return static_cast<std::uint8_t>(std::lround(255 * (srgb ? srgb_from_linear(v) : v)));
  }

  OIIO::ImageInput& input_;
  std::size_t channels_;
  TextureEncoding encoding_;
  int step_ = 1;
  bool is_float_ = false;
  TextureImage image_;
};

TextureRead failed(std::string problem) {
  return {nullptr, std::move(problem)};
}

TextureRead read_image(std::unique_ptr<OIIO::ImageInput> input, const std::string& source,
                       TextureEncoding encoding, double most_texels) {
  if (!input) {
    const std::string error = OIIO::geterror();  // clears it, so that it does not surface elsewhere
    return failed(fmt::format("{} cannot be read as an image: {}", source, error));
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.nchannels < 1 || spec.nchannels > 4)
    return failed(fmt::format("{} has {} channels; textures have 1 (grey) to 4 (red, green, blue, opacity)",
                              source, spec.nchannels));
  if (spec.width < 1 || spec.height < 1 || spec.width > kLongestSide || spec.height > kLongestSide ||
      1.0 * spec.width * spec.height > kMostRead)
    return failed(fmt::format("{} has {} x {} texels, which is too much", source, spec.width, spec.height));
  ImageReading reading(*input, encoding, most_texels);
  const bool whole = reading.read();
  const std::string error = input->geterror();
  // The JPEG decoder makes up what a file lacks at its end, and what else it tells of is often harmless.
  if (!whole || error.find("Premature end") != std::string::npos)
    return failed(fmt::format("{} is damaged or cut off: {}", source, error));
  TextureImage image = reading.take();
  image.source = source;
  finish_texture_image(image);
  return {std::make_shared<const TextureImage>(std::move(image)), ""};
}

}  // namespace

TextureRead TextureImages::from_file(const std::filesystem::path& file, TextureEncoding encoding) {
  const std::string name = file.string();
  const auto known = known_.find({name, encoding});
  if (known != known_.end()) return known->second;
  TextureRead read;
  try {
    check_readable_file(file);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    read = read_image(OIIO::ImageInput::open(name, &config), name, encoding,
                      std::max(kLeastTexels, std::min(kMostTexels, texels_left_ / 4)));
  } catch (const InputError& error) {
    read = failed(error.what());
  }
  if (read.image) texels_left_ -= 1.0 * read.image->width * read.image->height;
  return known_[{name, encoding}] = read;
}

TextureRead TextureImages::from_memory(const std::string& name, const std::string& kind,
                                       const unsigned char* bytes, std::size_t size,
                                       TextureEncoding encoding) {
  const auto known = known_.find({name, encoding});
  if (known != known_.end()) return known->second;
  OIIO::Filesystem::IOMemReader memory(bytes, size);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::Filesystem::IOProxy* proxy = &memory;  // with a configuration, only that is asked for it
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  TextureRead read = read_image(OIIO::ImageInput::open(kind, &config, proxy), name, encoding,
                                std::max(kLeastTexels, std::min(kMostTexels, texels_left_ / 4)));
  if (read.image) texels_left_ -= 1.0 * read.image->width * read.image->height;
  return known_[{name, encoding}] = read;
}

std::string reduction_note(const TextureImage& image) {
  if (image.read_width == image.width && image.read_height == image.height) return "";
  return fmt::format("{}: {} x {} texels are averaged to {} x {}", image.source, image.read_width,
                     image.read_height, image.width, image.height);
}

}  // namespace reemit
