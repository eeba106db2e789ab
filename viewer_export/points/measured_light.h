#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/output/export_info.h"
#include "viewer_export/points/point_set.h"

namespace reemit {

struct MeasureSettings {
  int gather_rays = 4096;  ///< Per point, rounded up [1, 1048576].
  /// Shadow rays per point, of up to 64 luminaires to each; rounded up [1, 65536].
  int light_samples = 1024;
  /// Relative error to reach as a fraction [0, 1), SetSummary::error of each set, with s the standard error
  /// of irradiance E. 0 = take the samples above; else only their ratio counts.
  double error_target = 0;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores. The values do not depend on it.
};

/// Irradiance of a point: straight from luminaires, and all of it, with its standard error.
struct Irradiance {
  float all = 0;
  float standard_error = 0;  ///< 15 degrees of freedom: a 95 % interval is 2.13 of it to each side.
  float direct = 0;          ///< Without what comes over mirrors and glass.
};

/// Of the points of one set [lx].
struct SetSummary {
  double mean = 0;
  double standard_error =
      0;  ///< Of the mean, +infinity if not known; knows what errors of points have in common.
  double least = 0, most = 0;
  /// Relative, rms over its points: sqrt(sum s^2 / sum E^2), worst band. +infinity if not known, as where
  /// all points are dark.
  double error = 0;
  std::vector<std::size_t> dark_points;  ///< Where no ray found light, by their places in the set.
  double uniformity() const { return mean > 0 ? least / mean : 0; }  ///< Least over mean.
};

/// Light at points in the air. Point i of all sets in their order has the values i.
struct MeasuredLight {
  ExportInfo info;
  BandSet bands = BandSet::grey();
  /// Under a sky: its illuminance on a horizontal plane outside, without the sun [lx]; else 0.
  double outside = 0;
  std::vector<PointSet> sets;
  std::vector<SetSummary> summaries;    ///< By set.
  std::vector<Irradiance> irradiance;   ///< [W/m2]; index point * bands + band.
  std::vector<Irradiance> illuminance;  ///< [lx], by point; the error is that of the sum over bands.
  /// An error target was missed because of the noise of the zones or, with has_photons, of photons.
  bool limited_by_zones = false;
  bool has_photons = false;  ///< Light over mirrors and glass comes by photons (CausticMap).
};

/// Gets the finished share of the work [0,1], from one thread at a time.
using MeasureProgress = std::function<void(double)>;

/// Irradiance at points that are no part of the room, by direct light and final gather there as at vertices
/// (gather_vertices), with photons of light over mirrors and glass that pass them. `progress` may be empty.
/// Throws InputError for settings out of range, for sets without points or with points that are no places or
/// normals that are not unit, and for a room that is not the one solved; ResourceError for more points than
/// memory holds, Interrupted when `interrupt` becomes true.
MeasuredLight measure_light(const Room& room, const Solution& solution, std::vector<PointSet> sets,
                            const MeasureSettings& settings, const MeasureProgress& progress,
                            const std::atomic<bool>& interrupt);

}  // namespace reemit
