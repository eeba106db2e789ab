#include "scenes/model/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scenes/model/fnv1a.h"

namespace reemit {
namespace {

/// Part of texel i of a row of `from` texels, in a copy with `to` texels, that lies in texel k of the copy.
double overlap(int i, int k, int from, int to) {
  const double scale = static_cast<double>(from) / to;
  return std::max(0.0, std::min(i + 1.0, (k + 1) * scale) - std::max<double>(i, k * scale));
}

template <class TexelAt>
TextureLevel shrunk(int width, int height, TexelAt&& texel_at) {
  TextureLevel level{std::max(1, width / 2), std::max(1, height / 2), {}};
  level.texels.reserve(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  const double x_scale = static_cast<double>(width) / level.width;
  const double y_scale = static_cast<double>(height) / level.height;
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x) {
      std::array<double, 4> sum{};
      for (int j = static_cast<int>(y * y_scale); j < height && j < (y + 1) * y_scale; ++j)
        for (int i = static_cast<int>(x * x_scale); i < width && i < (x + 1) * x_scale; ++i) {
          const double weight = overlap(i, x, width, level.width) * overlap(j, y, height, level.height);
          const Texel t = texel_at(i, j);
          for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * static_cast<double>(t[c]);
        }
      Texel& mean = level.texels.emplace_back();
      for (std::size_t c = 0; c < 4; ++c) mean[c] = static_cast<float>(sum[c] / (x_scale * y_scale));
    }
  return level;
}

std::uint64_t hash_of(const TextureImage& image) {
  Fnv1a hash;
  hash.add(static_cast<std::uint32_t>(image.width));
  hash.add(static_cast<std::uint32_t>(image.height));
  if (!image.bytes.empty()) hash.add(std::bit_cast<std::uint32_t>(image.decoded[128]));
  for (std::size_t i = 0; i + 3 < image.bytes.size(); i += 4)
    hash.add(static_cast<std::uint32_t>(image.bytes[i]) |
             static_cast<std::uint32_t>(image.bytes[i + 1]) << 8 |
             static_cast<std::uint32_t>(image.bytes[i + 2]) << 16 |
             static_cast<std::uint32_t>(image.bytes[i + 3]) << 24);
  for (const Texel& t : image.texels)
    for (const float x : t) hash.add(std::bit_cast<std::uint32_t>(x == 0 ? 0.0F : x));
  return hash.state();
}

}  // namespace

std::size_t TextureImage::memory() const {
  std::size_t size = bytes.size() + sizeof(Texel) * texels.size();
  for (const TextureLevel& level : levels) size += sizeof(Texel) * level.texels.size();
  return size;
}

void finish_texture_image(TextureImage& image) {
  image.hash = hash_of(image);
  image.levels.clear();
  image.largest = image.texel(0, 0);
  image.is_grey = true;
  image.smallest_opacity = image.largest[3];
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Texel t = image.texel(x, y);
      for (std::size_t c = 0; c < 4; ++c) image.largest[c] = std::max(image.largest[c], t[c]);
      image.smallest_opacity = std::min(image.smallest_opacity, t[3]);
      image.is_grey = image.is_grey && t[0] == t[1] && t[1] == t[2];
    }
  int width = image.width;
  int height = image.height;
  while (width > 1 || height > 1) {
    if (image.levels.empty()) {
      image.levels.push_back(shrunk(width, height, [&](int x, int y) { return image.texel(x, y); }));
    } else {
      const TextureLevel& last = image.levels.back();
      TextureLevel next = shrunk(width, height, [&](int x, int y) {
        return last.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(last.width) +
                           static_cast<std::size_t>(x)];
      });
      image.levels.push_back(std::move(next));
    }
    width = image.levels.back().width;
    height = image.levels.back().height;
  }
  image.mean = image.levels.empty() ? image.texel(0, 0) : image.levels.back().texels[0];
}

}  // namespace reemit
