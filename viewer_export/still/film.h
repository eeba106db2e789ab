#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/vec.h"
#include "solver/tally/replicates.h"
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

/// What one block of samples of one replicate found out about one pixel; means over its samples.
struct PixelBlock {
  const float* direct;    ///< Emission and first reflection of luminaires [W/(m2 sr)], per band.
  const float* indirect;  ///< The rest [W/(m2 sr)], per band.
  /// First reflection of luminaires over mirrors, glass and gloss [W/(m2 sr)], per band; null where there is
  /// no such layer.
  const float* caustic = nullptr;
  const float* albedo;   ///< Reflectance [0,1], per band.
  Vec3 normal{0, 0, 0};  ///< Sum over samples that saw something.
  double depth = 0;      ///< Sum over samples that saw something [m].
  int seen = 0;          ///< Samples that saw something.
  int luminous = 0;      ///< Samples that saw a luminaire (StillImage::luminous).
  int mirroring = 0;     ///< Samples that met a mirror, gloss or glass first.
  int samples = 0;
  int earlier = 0;  ///< Samples that this replicate of the pixel had before.
};

/// The growing picture. A pixel is the mean of a few replicates, each an independent randomised quasi-Monte
/// Carlo estimate that grows by blocks; their spread is the standard error. All replicates of a pixel have
/// the same number of samples, pixels may differ. Different pixels may be written from different threads.
class Film {
 public:
  static constexpr std::size_t kReplicates = 8;

  /// `replicates`: 1 to kReplicates; with one there are no errors. `parts`: of the zone solution that the
  /// replicates read in turn, as mean_of_replicates takes it. `caustics`: there is a layer of them. Throws
  /// ResourceError when the layers do not fit into memory.
  Film(const BandSet& bands, int width, int height, std::size_t replicates, std::size_t parts = 1,
       bool caustics = false);

  /// Memory that a pixel takes while rendering [bytes].
  static std::size_t bytes_per_pixel(std::size_t bands, std::size_t replicates, bool caustics);

  /// The replicates of a pixel begin in their order.
  void add(std::size_t pixel, std::size_t replicate, const PixelBlock& block);

  std::size_t replicates() const { return replicates_; }
  bool has_gaps() const;  ///< A pixel has no sample.
  // Pre of both: all replicates of the pixel have begun.
  /// Mean radiance and the square of its standard error, infinite with one replicate.
  ReplicateMean replicate_mean(std::size_t pixel, std::size_t band) const;
  /// Mean radiance alone [W/(m2 sr)].
  double radiance(std::size_t pixel, std::size_t band) const;
  /// Size, bands and the layers that hold means already: direct, caustic, albedo, samples.
  const StillImage& image() const { return image_; }

  /// The picture by the even and by the odd replicates, which read different parts of the zone solution where
  /// it has parts; empty where a pixel has not begun an even number of replicates.
  StillHalves halves() const;

  /// The picture so far. Pre: all replicates of all pixels have begun.
  StillImage snapshot() const;

  /// Makes the layers and hands the picture over. Replicates that have not begun do not count, and there are
  /// no errors where a pixel has fewer than two. The film is empty afterwards.
  StillImage finish();

 private:
  ReplicateMean mean_so_far(std::size_t pixel, std::size_t band) const;
  float indirect(std::size_t pixel, std::size_t band, float radiance) const;
  /// From sums to means and errors, of a pixel of a picture that has the layers of this one.
  void complete_geometry(StillImage& image, std::size_t pixel) const;

  std::size_t bands_;
  std::size_t replicates_;
  std::size_t parts_;
  // depth, normal: sums over samples that saw something; luminous, mirroring: their number;
  // albedo_stderr: squared deviations of blocks from their mean, each as often as it has samples.
  StillImage image_;
  std::array<std::vector<float>, kReplicates> means_;
  std::vector<float> seen_;
  std::vector<std::uint8_t> begun_;    // replicates, by pixel
  std::vector<std::uint32_t> blocks_;  // by pixel
};

}  // namespace reemit
