#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "scenes/model/bands.h"
#include "viewer_export/output/export_info.h"

namespace reemit {

/// A picture of the room in physical units. Pixels in rows from the top left: pixel = y * width + x. A layer
/// that was not computed is empty; `radiance` is always there.
struct StillImage {
  ExportInfo info;
  /// True if an error target was missed because of the noise of the zone solution.
  bool limited_by_zones = false;
  /// Pixels are means of pixels around them (smooth_still).
  bool smoothed = false;
  /// Stopped before it was done: somebody waits, so that files of it are not packed (deflated).
  bool interrupted = false;
  BandSet bands = BandSet::grey();
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]

  // bands.count() values per pixel: index pixel * bands + band.
  std::vector<float> radiance;  ///< The picture [W/(m2 sr)].
  std::vector<float> direct;    ///< Part that is emission and first reflection of luminaires [W/(m2 sr)].
  std::vector<float> indirect;  ///< The rest [W/(m2 sr)].
  /// First reflection of luminaires over mirrors, glass and gloss [W/(m2 sr)]; in rooms that have them.
  std::vector<float> caustic;
  std::vector<float> radiance_stderr;  ///< Standard error of `radiance` [W/(m2 sr)].
  std::vector<float> albedo;           ///< Reflectance of what is seen, over smooth mirrors and panes too.
  /// Standard error of `albedo`: by chance samples meet more or less of what a pixel shows besides.
  std::vector<float> albedo_stderr;

  std::vector<float> samples;  ///< One per pixel: camera rays.
  /// One per pixel: the share of them that saw a luminaire, straight or over smooth mirrors and panes.
  std::vector<float> luminous;
  std::vector<float>
      mirroring;              ///< One per pixel: the share of them that met a mirror, gloss or glass first.
  std::vector<float> depth;   ///< One per pixel: distance from the eye [m]; +inf where nothing is seen.
  std::vector<float> normal;  ///< Three per pixel: unit, world coordinates; 0 where nothing is seen.

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// The radiance of a still from two disjoint halves of its replicates [W/(m2 sr)], laid out as
/// StillImage::radiance: their mean is the picture.
using StillHalves = std::array<std::vector<float>, 2>;

/// Throws std::invalid_argument when a layer's size does not fit the picture.
void check_consistent(const StillImage& image);

/// 1 / (L + floor) by pixel, by which errors of radiance L are taken relative; 0 where both are 0.
/// `radiance`: as StillImage::radiance of `bands` bands; the floor is `error_floor` times its mean in this
/// band.
std::vector<double> relative_scales(const std::vector<float>& radiance, std::size_t bands, std::size_t band,
                                    double error_floor);

/// The picture in linear Rec.709, 3 values per pixel.
std::vector<float> rgb_of(const StillImage& image);

}  // namespace reemit
