#pragma once
#include <cstddef>
#include <vector>

#include "scenes/model/camera.h"
#include "scenes/model/scene.h"

namespace reemit::hit_paths {

struct ComparisonSettings;

/// Sums over passes of the mean radiance [W/(m2 sr)] of one block, by band; a pass is one path through each
/// of its pixels.
struct BlockSums {
  std::vector<double> sum, squares;
  int passes = 0;

  double mean(std::size_t b) const { return sum[b] / passes; }
  double standard_error(std::size_t b) const;  ///< Of the mean.
  double worst_relative_error() const;         ///< Over bands with light; 0 if none has.
};

/// The picture of a camera, block by block, by paths that only hit luminaires: as many as the settings say,
/// or as their time allows. Throws std::invalid_argument for rooms with luminaires that the reference does
/// not know.
std::vector<BlockSums> trace_reference(const Scene& scene, const Camera& camera,
                                       const ComparisonSettings& settings);

}  // namespace reemit::hit_paths
