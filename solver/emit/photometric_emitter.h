#pragma once
#include <memory>

#include "scenes/model/luminaire.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// Where a shadow ray for a luminaire without area goes, and what arrives if it gets through.
struct PunctualSample {
  float factor = 0;          ///< Irradiance per unit of emission_of over the density; 0 if x is not lit.
  bool at_infinity = false;  ///< `target` is a unit direction towards the luminaire, else a point.
  Vec3f target{0, 0, 0};     ///< Normalised.
};

/// A measured luminaire in the normalised space. Every point of the opening sends out the distribution of the
/// table, so irradiance is the mean of I cos/r^2 over the opening at every distance: there is no distance at
/// which a point takes over, and so no seam.
class PhotometricEmitter {
 public:
  PhotometricEmitter(const PhotometricLight& light, const RayScene& rays);

  /// About the irradiance at x (normal n) per unit of intensity_per_candela [cd/m2] if nothing is in the way:
  /// exact for points, a mean over a few points of the opening else. Above 0 wherever a point of the opening
  /// lies above the horizon of x.
  float expected_irradiance(const Vec3f& x, const Vec3f& n) const;

  /// A point of the opening for two uniform numbers: factor = I cos/r^2 [cd/m2], r in metres. Within
  /// kNearest of the size of the opening r counts as that much.
  PunctualSample sample(const Vec3f& x, const Vec3f& n, float u0, float u1) const;

  /// Distance, in sizes of the opening, below which irradiance grows no more. A homogeneous opening says
  /// nothing about what is that close, and without a bound the irradiance of a surface that touches it at a
  /// right angle is infinite.
  static constexpr double kNearest = 1e-3;
  /// Rays start, and shadow rays end, that far off the opening [normalised], so that an opening in the plane
  /// of a ceiling shines out of it.
  static constexpr double kClear = 1e-5;

 private:
  Vec3 point(double u0, double u1) const;  // normalised
  double kernel(const Vec3& to_light, const Vec3& n) const;

  std::shared_ptr<const IntensityTable> table_;
  LuminousOpening opening_;
  Vec3 centre_;              // normalised
  Eigen::Matrix3d to_room_;  // luminaire coordinates to the room
  double metres_;            // per normalised unit
  double nearest2_;          // [normalised units^2]
  double extent2_;           // [normalised units^2]
};

/// Start of a packet of a measured luminaire in the normalised space; all packets carry the same power. u0,
/// u1 place it, u2, u3 turn it.
void start_photometric_ray(const PhotometricLight& light, const RayScene& rays, float u0, float u1, float u2,
                           float u3, Vec3f& origin, Vec3f& direction);

}  // namespace reemit
