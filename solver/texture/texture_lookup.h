#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scenes/model/texture.h"

namespace reemit {

/// The texel of a row of `size` that stands for number i, which may lie beyond its ends.
inline int wrapped(int i, int size, TextureWrap wrap) {
  if (i >= 0 && i < size) return i;
  if (wrap == TextureWrap::kClamp) return std::clamp(i, 0, size - 1);
  const int period = wrap == TextureWrap::kMirror ? 2 * size : size;
  int k = i % period;
  if (k < 0) k += period;
  return k < size ? k : period - 1 - k;
}

/// Values of one copy of an image at (u,v) of it, interpolated between the four nearest texels or not.
/// `texel_at`: of x and y.
template <class TexelAt>
Texel value_of_copy(const Texture& texture, int width, int height, float u, float v, TexelAt&& texel_at) {
  constexpr float kFarthest = 1e9F;  // what an int holds
  const float x = std::clamp(u * static_cast<float>(width), -kFarthest, kFarthest);
  const float y = std::clamp(v * static_cast<float>(height), -kFarthest, kFarthest);
  const auto column = [&](int i) { return wrapped(i, width, texture.wrap_u); };
  const auto row = [&](int i) { return wrapped(i, height, texture.wrap_v); };
  if (texture.nearest)
    return texel_at(column(static_cast<int>(std::floor(x))), row(static_cast<int>(std::floor(y))));
  const float left = std::floor(x - 0.5F);
  const float top = std::floor(y - 0.5F);
  const float a = x - 0.5F - left;
  const float b = y - 0.5F - top;
  const int i0 = column(static_cast<int>(left));
  const int i1 = column(static_cast<int>(left) + 1);
  const int j0 = row(static_cast<int>(top));
  const int j1 = row(static_cast<int>(top) + 1);
  const Texel t00 = texel_at(i0, j0);
  const Texel t10 = texel_at(i1, j0);
  const Texel t01 = texel_at(i0, j1);
  const Texel t11 = texel_at(i1, j1);
  Texel value;
  for (std::size_t c = 0; c < 4; ++c)
    value[c] = (1 - b) * ((1 - a) * t00[c] + a * t10[c]) + b * ((1 - a) * t01[c] + a * t11[c]);
  return value;
}

/// Of copy number `level`, 0 being the image itself.
inline Texel value_at_level(const Texture& texture, std::size_t level, float u, float v) {
  const TextureImage& image = *texture.image;
  if (level == 0)
    return value_of_copy(texture, image.width, image.height, u, v,
                         [&](int x, int y) { return image.texel(x, y); });
  const TextureLevel& copy = image.levels[level - 1];
  return value_of_copy(texture, copy.width, copy.height, u, v, [&](int x, int y) {
    return copy.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(copy.width) +
                       static_cast<std::size_t>(x)];
  });
}

/// Values at (u,v) of the image, averaged over a spot of that many texels across: between the two copies of
/// the image whose texels are next to that in size [WIL83].
inline Texel texture_value(const Texture& texture, float u, float v, float texels) {
  if (!(texels > 1) || texture.image->levels.empty()) return value_at_level(texture, 0, u, v);
  const float level = std::log2(texels);
  const auto last = texture.image->levels.size();
  const auto below = static_cast<std::size_t>(level);
  if (below >= last) return value_at_level(texture, last, u, v);
  const float share = level - static_cast<float>(below);
  const Texel fine = value_at_level(texture, below, u, v);
  const Texel coarse = value_at_level(texture, below + 1, u, v);
  Texel value;
  for (std::size_t c = 0; c < 4; ++c) value[c] = (1 - share) * fine[c] + share * coarse[c];
  return value;
}

}  // namespace reemit
