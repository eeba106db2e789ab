#pragma once
#include <array>
#include <optional>

#include "scenes/model/shape.h"
#include "solver/sampling/shapes/azimuth_elevation.h"
#include "solver/sampling/shapes/shape_density.h"

namespace reemit {

/// Disk, front side emitting: p4 of [SWZ96] sec. 3.3.2 (kArea and kVisibleArea), and by azimuth and elevation
/// about its normal the part above the horizon (kSolidAngle, kCosine).
class DiskSampler {
 public:
  DiskSampler(const Disk& disk, const Vec3& x, const Vec3& n, Density density);

  bool lights() const { return lights_; }
  Density density() const { return density_; }
  ShapePoint sample(double u0, double u1) const;
  double pdf_per_sr(const Vec3& point) const;
  std::array<double, 2> invert(const Vec3& point) const;
  /// Closed form [sr], cut by the horizon or not: the contour integral [SPA63] of the arc above the horizon
  /// and of its chord.
  double irradiance() const;

 private:
  Disk disk_;
  Vec3 x_, n_;
  bool lights_ = false;
  Density density_;
  double height_ = 0;  // of x above the disk
  Vec3 foot_;          // of x in the plane of the disk
  Vec3 towards_;       // unit, from the foot to the centre
  double offset_ = 0;  // distance from the foot to the centre
  std::optional<AzimuthElevation> angles_;
};

}  // namespace reemit
