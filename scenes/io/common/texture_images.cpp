#include "scenes/io/common/texture_images.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/srgb.h"
#include "scenes/io/common/text_file.h"
#include "scenes/io/images/image_library.h"
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
  ImageReading(ImageReader& reader, TextureEncoding encoding, double most_texels)
      : reader_(reader),
        layout_(reader.layout()),
        channels_(static_cast<std::size_t>(layout_.channels)),
        encoding_(encoding) {
    image_.read_width = layout_.width;
    image_.read_height = layout_.height;
    const auto texels = [&] {
      return std::ceil(1.0 * layout_.width / step_) * std::ceil(1.0 * layout_.height / step_);
    };
    while (texels() > most_texels) ++step_;
    image_.width = (layout_.width + step_ - 1) / step_;
    image_.height = (layout_.height + step_ - 1) / step_;
    image_.decoded = decoding_table(encoding);
    image_.has_opacity = channels_ == 2 || channels_ == 4;
  }

  /// False if the file ends early or is damaged.
  bool read() {
    return layout_.is_float ? read_rows<float>(PixelType::kFloat) : read_rows<std::uint8_t>(PixelType::kByte);
  }
  TextureImage take() { return std::move(image_); }

 private:
  template <class T>
  bool read_rows(PixelType type) {
    const int width = layout_.width, height = layout_.height, together = layout_.rows_together;
    const std::size_t row_size = static_cast<std::size_t>(width) * channels_;
    std::vector<T> rows(row_size * static_cast<std::size_t>(together));
    std::vector<Texel> sums(static_cast<std::size_t>(image_.width));
    for (int y = 0; y < height; ++y) {
      if (y % together == 0 && !reader_.read_rows(y, std::min(y + together, height), type, rows.data()))
        return false;
      const std::span row(&rows[row_size * static_cast<std::size_t>(y % together)], row_size);
      if (step_ == 1) {
        for (std::size_t i = 0; i < row.size(); i += channels_) keep(&row[i]);
        continue;
      }
      for (int x = 0; x < width; ++x) {
        const Texel t = linear(&row[static_cast<std::size_t>(x) * channels_]);
        Texel& sum = sums[static_cast<std::size_t>(x / step_)];
        for (std::size_t c = 0; c < 4; ++c) sum[c] += t[c];
      }
      if ((y + 1) % step_ == 0 || y + 1 == height) keep_means(sums, y % step_ + 1);
    }
    return true;
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
      if (layout_.is_float)
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

  ImageReader& reader_;
  ImageLayout layout_;
  std::size_t channels_;
  TextureEncoding encoding_;
  int step_ = 1;
  TextureImage image_;
};

TextureRead failed(std::string problem) {
  return {nullptr, std::move(problem)};
}

TextureRead read_image(const OpenedImage& opened, const std::string& source, TextureEncoding encoding,
                       double most_texels) {
  if (!opened.reader) return failed(fmt::format("{} cannot be read as an image: {}", source, opened.problem));
  const ImageLayout layout = opened.reader->layout();
  const int width = layout.width, height = layout.height;
  if (layout.channels < 1 || layout.channels > 4)
    return failed(fmt::format("{} has {} channels; textures have 1 (grey) to 4 (red, green, blue, opacity)",
                              source, layout.channels));
  if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide ||
      1.0 * width * height > kMostRead)
    return failed(fmt::format("{} has {} x {} texels, which is too much", source, width, height));
  ImageReading reading(*opened.reader, encoding, most_texels);
  const bool whole = reading.read();
  const std::string error = opened.reader->take_message();
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
    read = read_image(image_library().open(name), name, encoding,
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
  TextureRead read = read_image(image_library().open(kind, bytes, size), name, encoding,
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
