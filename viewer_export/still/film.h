#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/vec.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// How a pixel weighs the picture around its middle.
enum class PixelFilter {
  kBox,   ///< Evenly over the pixel.
  kTent,  ///< Falls linearly to 0 at the middles of the neighbours; smoother edges.
};
std::string to_string(PixelFilter filter);  ///< "box" or "tent".

/// Offset from the middle of a pixel [px] for a uniform number, distributed as the filter: samples need no
/// weights, and pixels share none.
double sample_filter(PixelFilter filter, double u);

/// What one pass found out about one pixel; means over the pass's samples.
struct PixelPass {
  const float* direct;    ///< Emission and first reflection of luminaires [W/(m2 sr)], per band.
  const float* indirect;  ///< The rest [W/(m2 sr)], per band.
  const float* albedo;    ///< Reflectance [0,1], per band.
  Vec3 normal{0, 0, 0};   ///< Sum over samples that saw something.
  double depth = 0;       ///< Sum over samples that saw something [m].
  int seen = 0;           ///< Samples that saw something.
  int samples = 0;
};

/// The growing picture. Passes of equal size are independent estimates of a pixel: their mean is the picture
/// and their spread its standard error. Pixels may have had different numbers of passes. Different pixels may
/// be written from different threads.
class Film {
 public:
  /// Throws ResourceError when the layers do not fit into memory.
  Film(const BandSet& bands, int width, int height);

  /// Memory that a pixel takes while rendering [bytes].
  static std::size_t bytes_per_pixel(std::size_t bands);

  void add(std::size_t pixel, const PixelPass& pass);

  std::size_t passes(std::size_t pixel) const { return static_cast<std::size_t>(passes_[pixel]); }
  float radiance(std::size_t pixel, std::size_t band) const { return image_.radiance[pixel * bands_ + band]; }
  /// Square of the standard error; infinite before two passes.
  double squared_error(std::size_t pixel, std::size_t band) const;
  const StillImage& image() const { return image_; }

  /// Turns sums into layers and hands the picture over. The film is empty afterwards.
  StillImage finish();

 private:
  std::size_t bands_;
  StillImage image_;  // radiance, direct, albedo: means so far; radiance_stderr: sum of squared deviations;
                      // indirect: empty until finish; depth, normal: sums over samples that saw something
  std::vector<float> seen_;
  std::vector<float> passes_;
};

}  // namespace reemit
