#pragma once
#include <array>

#include "scenes/model/vec.h"

namespace reemit {

/// The part of a cone of directions that is above the horizon, uniform in cos(theta) d omega: uniform in its
/// orthographic projection on the tangent plane. Coordinates: z along the normal of the receiver, the axis of
/// the cone in the half plane y = 0, x >= 0. The projection of a whole cone is an ellipse; of one that the
/// horizon cuts, a region whose chords y = const have a closed-form length and integral. Successor of p3 of
/// [SWZ96] sec. 3.2.3 in the manner of [PD19].
class ProjectedCap {
 public:
  ProjectedCap() = default;
  /// Half angle alpha and angle theta of the axis from the normal, both as sine and cosine; alpha in
  /// (0, pi/2], theta in [0, pi].
  ProjectedCap(double sin_alpha, double cos_alpha, double sin_theta, double cos_theta);

  /// Projected solid angle [sr], closed form: pi sin^2(alpha) cos(theta) if nothing is below the horizon.
  double projected_solid_angle() const { return total_; }
  Vec3 sample(double u0, double u1) const;
  std::array<double, 2> invert(const Vec3& direction) const;

 private:
  double chord(double y) const;      // length of the slice
  double half_area(double y) const;  // slices 0 to y
  double to_rim(double y) const;     // distance along x from the middle of the ellipse to the unit circle

  double sin_alpha_ = 0, cos_theta_ = 0;
  double middle_ = 0;     // x of the middle of the ellipse, sin(theta) cos(alpha)
  double from_rim2_ = 0;  // 1 - middle^2
  double cut_ = 0;        // |y| below which the horizon cuts the slice; 0 if nowhere
  double end_ = 0;        // largest |y|
  double axis_z_ = 0;     // z of the middle of the cap's base, cos(theta) cos(alpha)
  double sin_theta_ = 0;
  double total_ = 0;
};

}  // namespace reemit
