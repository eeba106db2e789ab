#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

#include "scenes/model/camera.h"
#include "scenes/model/scene.h"
#include "viewer_export/still/still_image.h"

namespace reemit::hit_paths {

struct ComparisonSettings;

constexpr int kBlock = 16;  ///< Pixels along an edge of a block.

/// Mean radiance of one block in one band over independent pictures.
struct CheckedBlock {
  std::vector<double> values;
  double pixels_error = 0;  ///< Standard error of their sum by the noise of single pixels.

  double mean() const;
  double standard_error() const;  ///< Of the mean: by the spread, if there is one, but not below the pixels'.
};

/// The picture that is checked, block by block.
struct CheckedPicture {
  int width = 0;   ///< [px]; what is left of whole blocks at the right and below is not looked at.
  int height = 0;  ///< [px]
  std::size_t bands = 1;
  std::vector<CheckedBlock> blocks;  ///< By block, then band.

  int across() const { return width / kBlock; }
  std::size_t count() const {
    return static_cast<std::size_t>(across()) * static_cast<std::size_t>(height / kBlock);
  }
};

/// Renders it as the program does: eight times, each with a zone solution of its own. Only so does their
/// spread hold the noise of the zones, which the pixels of a block share.
CheckedPicture render_checked(const Scene& scene, const Camera& camera, const ComparisonSettings& settings);

/// EXR files that the program wrote of one view, each of a solution of its own with another seed. Of a single
/// one the errors are those of its pixels alone: too small by the noise of the zones. Throws
/// std::invalid_argument for files that are no such pictures of the bands, or differ in size.
CheckedPicture read_checked(const std::vector<std::filesystem::path>& files, const BandSet& bands);

}  // namespace reemit::hit_paths
