#pragma once
#include <array>
#include <optional>

#include "scenes/model/shape.h"
#include "solver/sampling/shapes/azimuth_elevation.h"
#include "solver/sampling/shapes/shape_density.h"

namespace reemit {

/// Mantle of a cylinder [SWZ96] sec. 3.4: uniform in area, in the area of the side turned towards x
/// (kVisibleArea), and by azimuth and elevation about its axis the part that x sees above its horizon
/// (kSolidAngle, kCosine). From outside, the inside of a mantle is seen through its ends; what the mantle
/// hides of itself counts as not lighting, whatever the density.
class CylinderSampler {
 public:
  CylinderSampler(const Cylinder& cylinder, const Vec3& x, const Vec3& n, Density density);

  bool lights() const { return lights_; }
  Density density() const { return density_; }
  ShapePoint sample(double u0, double u1) const;
  double pdf_per_sr(const Vec3& point) const;
  std::array<double, 2> invert(const Vec3& point) const;

 private:
  /// Does the mantle itself hide a point of its inside from x?
  bool hidden(const Vec3& point) const;
  Vec3 outward(const Vec3& point) const;

  Cylinder cylinder_;
  Vec3 x_, n_;
  Vec3 axis_, towards_, across_;  // towards: from x to the axis line
  double length_ = 0;
  double offset_ = 0;  // of x from the axis line
  double low_ = 0;     // base relative to x, along the axis
  bool lights_ = false;
  Density density_;
  double middle_ = 0, half_ = 0;  // azimuths drawn by area, about `towards`
  double area_ = 0;
  std::optional<AzimuthElevation> angles_;
};

}  // namespace reemit
