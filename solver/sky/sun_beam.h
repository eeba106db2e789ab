#pragma once
#include <array>

#include "solver/sky/sky_entry.h"

namespace reemit {

/// Light of the sun's disk into the box around the room, as four uniform numbers: two for the point in a
/// rectangle across the beam, two for the direction. Packets of equal power are uniform in them.
class SunBeam {
 public:
  using Numbers = SkyEntry::Numbers;

  /// `towards`: unit, to the middle of the disk. `half_angle` of the disk [rad].
  SunBeam(const Vec3& towards, double half_angle, const SkyBox& box);

  const Vec3& axis() const { return axis_; }
  /// Of the disk [sr].
  double solid_angle() const { return solid_angle_; }
  /// Across the axis, of the rectangle [normalised].
  double area() const { return 4 * half_x_ * half_y_; }
  bool sees(const Vec3& towards) const { return towards.dot(axis_) >= cos_; }
  /// A direction towards the disk with density proportional to its cosine from the axis: of such directions
  /// the irradiance across the beam is the mean over one.
  Vec3 sample(double u0, double u1) const;
  SkyRay start(const Numbers& u) const;
  /// Pre: sees(towards), the point is in the box.
  void invert(const Vec3& point, const Vec3& towards, Numbers& u) const;

 private:
  Vec3 axis_, tangent_, bitangent_;
  double sin_, cos_, solid_angle_;
  double distance_;  // of the rectangle from the middle, beyond the box
  double half_x_, half_y_;
};

}  // namespace reemit
