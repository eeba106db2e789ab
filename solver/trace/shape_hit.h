#pragma once
#include "scenes/model/shape.h"

namespace reemit {

/// A curved shape of the normalised space as rays see it. Rays are given in single precision and taken as
/// exact; all arithmetic is double.
class ShapeTarget {
 public:
  explicit ShapeTarget(const CurvedShape& shape);

  /// How much sooner `first` finds a shape from within, at most; disks besides by a millionth of their
  /// distance.
  static constexpr double kSooner = 2e-6;

  /// Distance of the nearest hit beyond `near` and before `far` along a direction of about unit length;
  /// infinity if there is none.
  double nearest(const Vec3& origin, const Vec3& direction, double near, double far) const;
  /// The same as rays see it that look for what comes first: from within, the shape comes a little before
  /// what touches it from outside. Where they touch both are equally far, and a disk even nearer.
  double first(const Vec3& origin, const Vec3& direction, double near, double far) const;
  /// Smallest and largest coordinates.
  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }

 private:
  double nearest_on_sphere(const Vec3& to_centre, const Vec3& d, double near, double far) const;
  double nearest_on_mantle(const Vec3& from_base, const Vec3& d, double near, double far) const;
  double on_disk(const Vec3& from_base, const Vec3& d, double near, double far) const;

  bool encloses(const Vec3& point) const;

  bool is_sphere_;
  Vec3 centre_;
  double radius_ = 0;
  Frustum frustum_;
  Vec3 low_, high_;
};

}  // namespace reemit
