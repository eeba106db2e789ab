#pragma once
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/block_reference.h"

namespace reemit::hit_paths {

/// Limits of a whole picture, in standard errors: odds of a false alarm 6e-7 (normal; a picture's reference
/// has over 10^5 paths) for each comparison. Blocks: kMostErrors and kMostDeviation.
constexpr double kPictureLimit = 5;

/// A comparison of a few seconds.
inline ComparisonSettings quick(bool by_path) {
  ComparisonSettings settings;
  settings.width = 64;
  settings.height = 48;
  settings.passes = 256;
  settings.packets = 600'000;
  settings.spp = 64;
  settings.by_path = by_path;
  return settings;
}

/// Gathered and path-traced stills of the first camera show the picture of the reference, whose relative
/// standard error has to stay below `most_error`.
inline void expect_same_picture(const Scene& scene, const std::string& name, double most_error,
                                const std::vector<BlockSums>& reference) {
  const Camera& camera = scene.cameras.at(0);
  for (const bool by_path : {false, true}) {
    const Comparison c = compare_blocks(scene, camera, quick(by_path), reference);
    const std::string what = name + (by_path ? ", path traced" : ", gathered");
    EXPECT_EQ(c.different(), 0U) << what << ": worst block " << c.blocks.at(0).relative() << ", "
                                 << c.blocks.at(0).errors() << " standard errors";
    EXPECT_LE(std::abs(c.mean_deviation), kPictureLimit * c.mean_error)
        << what << ": " << c.mean_deviation << " +- " << c.mean_error;
    EXPECT_LT(c.mean_error, most_error) << what << ": too weak to tell";
  }
}

inline void expect_same_picture(const Scene& scene, const std::string& name, double most_error) {
  expect_same_picture(scene, name, most_error, trace_reference(scene, scene.cameras.at(0), quick(false)));
}

}  // namespace reemit::hit_paths
