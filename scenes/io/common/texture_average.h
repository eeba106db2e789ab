#pragma once
#include <filesystem>
#include <string>

#include <Eigen/Core>

namespace reemit {

/// Mean linear colour of an image file, or why there is none.
struct TextureAverage {
  Eigen::Array3d rgb{0, 0, 0};
  std::string problem;  ///< Empty: rgb is valid.
};

/// Averages all pixels in linear light: integer images are taken as sRGB and decoded first [IEC61966],
/// floating-point ones as linear. One channel counts as grey, alpha is ignored, values are clamped to [0,1].
/// At most 2^26 pixels.
TextureAverage average_texture(const std::filesystem::path& file);

}  // namespace reemit
