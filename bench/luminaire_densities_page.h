#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "solver/sampling/shapes/shape_density.h"

namespace reemit::bench {

inline constexpr std::array<Density, 4> kDensities{Density::kArea, Density::kVisibleArea,
                                                   Density::kSolidAngle, Density::kCosine};
inline constexpr std::array<const char*, 4> kNames{"area", "visible area", "solid angle", "cosine"};
inline constexpr std::array<double, 6> kDistances{0.05, 0.3, 1, 3, 10, 100};
inline constexpr int kReuse = 16;  ///< Samples per sampler in the second timing.

struct Options {
  int places = 64;
  int samples = 4096;
  int repeats = 5;
  double ray_ns = 0;  // of a shadow ray; 0: measure it
  std::string folder;
};

/// One density of one shape at one distance.
struct Row {
  std::string shape;
  double distance = 0;
  std::size_t density = 0;
  double variance = 0;     // of one sample over the squared mean, places pooled
  double in_penumbra = 0;  // the same with the luminaire cut by the plane
  double ns_one = 0;       // per sample, one sample per place
  double ns_many = 0;      // per sample, kReuse samples per place

  /// Relative error after `ns` nanoseconds, half of the places lit in full and half in penumbra.
  double error_after(double ns, double ray, double own) const {
    return std::sqrt(0.5 * (variance + in_penumbra) * (own + ray) / ns);
  }
};

/// The density with the least error at equal time among those of one shape and distance, which begin at
/// `first`; shadow ray included, one sample or `many` per place.
std::size_t best_of(const std::vector<Row>& rows, std::size_t first, double ray, bool many);

void write_csv(const std::vector<Row>& rows, double ray, const std::filesystem::path& file);
void write_page(const std::vector<Row>& rows, double ray, const Options& options,
                const std::filesystem::path& file);

}  // namespace reemit::bench
