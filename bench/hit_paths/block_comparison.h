#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/model/camera.h"
#include "scenes/model/scene.h"

namespace reemit::hit_paths {

struct BlockSums;

/// A block beyond both limits differs: one alone is chance (5 standard errors: odds of 1 in 1.7 million) or
/// too little to see.
constexpr double kMostErrors = 5;
constexpr double kMostDeviation = 0.03;

struct ComparisonSettings {
  int width = 128;  ///< [px]
  int height = 96;
  double seconds = 30;  ///< For the reference [s]; it stops sooner when its error is small enough.
  int passes = 0;  ///< Paths per pixel of the reference instead, a multiple of 8: the same on any machine.
  double reference_error = 0.006;     ///< Median over blocks at which the reference stops.
  std::uint64_t packets = 8'000'000;  ///< Of the zone solutions, all together.
  int spp = 256;                      ///< Of the still that is checked.
  double zone_area = 0;               ///< [m2], 0 = default.
  std::uint64_t seed = 1;
  double planted_bias = 0;  ///< Added to the checked picture as a share, to see whether it would be noticed.
  bool by_walks = false;    ///< Solve the zones by walks instead of shooting.
  bool by_path = false;     ///< Check the path tracer instead of gathering.
  std::vector<std::filesystem::path> stills;  ///< Checked instead of rendering; their size counts.
  std::filesystem::path photometry;  ///< IES file that the reference reads anew for measured luminaires.
};

/// One block of pixels in its worst band.
struct BlockDeviation {
  int x = 0, y = 0;      ///< Upper left pixel.
  double checked = 0;    ///< Mean radiance of the checked picture [W/(m2 sr)].
  double reference = 0;  ///< Of the reference.
  double stderr_of_difference = 0;
  double errors() const { return (checked - reference) / stderr_of_difference; }
  double relative() const { return checked / reference - 1; }
  bool differs() const;
};

struct Comparison {
  std::string camera;
  std::vector<BlockDeviation> blocks;  ///< Those with light, by falling |errors|.
  double mean_deviation = 0;           ///< Of the whole picture, relative.
  double mean_error = 0;               ///< Relative standard error of that.
  double reference_error = 0;          ///< Median relative standard error of the blocks' references.
  double largest_reference_error = 0;
  std::uint64_t paths = 0;
  std::size_t different() const;  ///< Blocks that differ.
};

/// Renders the still as the program does, or reads it, and the reference by paths that only hit luminaires,
/// and compares them block by block. Deterministic but for the number of reference paths, which the clock
/// decides. Throws std::invalid_argument for rooms with luminaires that the reference does not know.
Comparison compare_blocks(const Scene& scene, const Camera& camera, const ComparisonSettings& settings);

/// The same against a reference of this view (trace_reference) that was traced before, at the size of the
/// settings.
Comparison compare_blocks(const Scene& scene, const Camera& camera, const ComparisonSettings& settings,
                          const std::vector<BlockSums>& reference);

}  // namespace reemit::hit_paths
