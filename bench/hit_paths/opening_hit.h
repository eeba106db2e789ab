#pragma once
#include <memory>
#include <random>

#include "bench/hit_paths/photometry_file.h"
#include "scenes/model/luminaire.h"

namespace reemit::hit_paths {

/// A measured luminaire as paths meet it. Its opening is not seen by the camera and hides nothing, and every
/// point of it sends out the intensities of the file over the points' share of its surface: a path towards it
/// finds the radiance I / (A cos) at each crossing (docs/ies.md).
class OpeningHit {
 public:
  /// `clearance` [m]: light leaves the opening that far off it. Throws std::invalid_argument for openings
  /// that are flat without being a rectangle or an ellipse.
  OpeningHit(const PhotometricLight& light, std::shared_ptr<const Photometry> photometry, double clearance);

  /// True if the opening has an area. Others, points and lines, are asked for by `random_point`.
  bool can_be_hit() const { return can_be_hit_; }
  /// Radiance that arrives at `origin` from along a ray of unit direction that ends at `far`, of 1 W/sr for
  /// each candela.
  double radiance(const Vec3& origin, const Vec3& direction, double far) const;

  Vec3 random_point(std::mt19937_64& random) const;  ///< Of a line; a point is always the same.
  /// Irradiance across the way from a point of the opening to x, of 1 W/sr for each candela.
  double irradiance(const Vec3& from, const Vec3& x) const;

 private:
  template <class Use>
  void for_each_crossing(const Vec3& o, const Vec3& d, Use&& use) const;

  const PhotometricLight* light_;
  std::shared_ptr<const Photometry> photometry_;
  Vec3 size_;
  double clearance_;
  double nearest_;             // [m]; irradiance grows no more within it
  double side_ = 0, cap_ = 0;  // shares of a cylinder's mantle and of each of its ends
  bool can_be_hit_ = false;
};

}  // namespace reemit::hit_paths
