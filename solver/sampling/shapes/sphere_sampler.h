#pragma once
#include <array>

#include "scenes/model/shape.h"
#include "solver/sampling/shapes/projected_cap.h"
#include "solver/sampling/shapes/shape_density.h"

namespace reemit {

/// Sphere [SWZ96] sec. 3.2: p1 (kArea), its restriction to the visible cap (kVisibleArea), p2 (kSolidAngle)
/// and the part above the horizon by projected solid angle (kCosine, in place of p3; no variance). Seen from
/// outside, a sphere lights if its front is the outside, or if it is clear: then its far inner side does, and
/// kVisibleArea is kArea. Seen from inside, it lights if its front is the inside: then kSolidAngle and
/// kCosine draw from the hemisphere above the horizon.
class SphereSampler {
 public:
  /// `is_clear`: light crosses it straight on.
  SphereSampler(const Sphere& sphere, const Vec3& x, const Vec3& n, Density density, bool is_clear = false);

  bool lights() const { return region_ != Region::kNone; }
  Density density() const { return density_; }
  ShapePoint sample(double u0, double u1) const;
  double pdf_per_sr(const Vec3& point) const;
  std::array<double, 2> invert(const Vec3& point) const;
  /// Closed form [sr]: pi (R/d)^2 cos(theta) above the horizon, that of ProjectedCap where it cuts the
  /// sphere, pi inside.
  double irradiance() const;

 private:
  enum class Region { kNone, kWholeArea, kCapArea, kCone, kHemisphere, kProjectedHemisphere, kProjectedCap };

  /// Where a direction from x meets the emitting side.
  Vec3 hit(const Vec3& direction) const;
  Vec3 to_world(const Vec3& local) const { return local.x() * e1_ + local.y() * e2_ + local.z() * e3_; }
  Vec3 to_local(const Vec3& v) const { return {v.dot(e1_), v.dot(e2_), v.dot(e3_)}; }

  Vec3 centre_, x_, n_;
  Vec3 to_centre_;     // centre - x
  Vec3 e1_, e2_, e3_;  // frame of the region
  double radius_;
  double distance_;        // |centre - x|
  double side_;            // +1: the outside emits
  bool inside_;            // x is
  double extent_ = 0;      // area [m2], or solid angle [sr], or projected solid angle, of the region
  double cap_height_ = 2;  // 1 - cos of the half angle of a cap or cone
  Density density_;
  Region region_ = Region::kNone;
  ProjectedCap cap_;
};

}  // namespace reemit
