#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

#include "scenes/model/camera.h"
#include "scenes/model/scene.h"
#include "viewer_export/still/still_image.h"

namespace reemit::hit_paths {

struct BlockDeviation;
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

/// Without a picture in it yet.
CheckedPicture empty_picture(int width, int height, std::size_t bands);

/// Adds one more independent picture of the same view, times a factor.
void add_still(const StillImage& image, double factor, CheckedPicture& picture);

/// The upper one of two middle values; 0 of none.
double median(std::vector<double> values);

/// Median over blocks of their relative standard errors: what a block has at least, for a few values know
/// their spread badly.
double median_spread(const CheckedPicture& picture);

/// By falling |errors|.
void sort_worst_first(std::vector<BlockDeviation>& blocks);

/// Two pictures of one view, each of several stills, block by block in the worst band: blocks with light, by
/// falling |errors|.
std::vector<BlockDeviation> compare_pictures(const CheckedPicture& checked, const CheckedPicture& reference);

/// Renders it as the program does: eight times, each with a zone solution of its own. Only so does their
/// spread hold the noise of the zones, which the pixels of a block share.
CheckedPicture render_checked(const Scene& scene, const Camera& camera, const ComparisonSettings& settings);

/// EXR files that the program wrote of one view, each of a solution of its own with another seed. Of a single
/// one the errors are those of its pixels alone: too small by the noise of the zones. Throws
/// std::invalid_argument for files that are no such pictures of the bands, or differ in size.
CheckedPicture read_checked(const std::vector<std::filesystem::path>& files, const BandSet& bands);

}  // namespace reemit::hit_paths
