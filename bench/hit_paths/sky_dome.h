#pragma once
#include "bench/hit_paths/path_random.h"
#include "scenes/model/scene.h"

namespace reemit::hit_paths {

/// What paths of the reference see where they leave the room: sky and ground by their formulas or pixels,
/// without tables, and without the sun, which shadow rays ask for.
class SkyDome {
 public:
  /// Black without a sky.
  explicit SkyDome(const Scene& scene);

  void add_radiance(const Vec3& direction, const Spectrum& weight, double* sum) const;
  bool has_sun() const { return sky_ != nullptr && sky_->sun_shines(); }
  /// A direction to the disk, uniform in solid angle.
  Vec3 towards_sun(PathRandom& random) const;
  /// Of the sun on a plane across such a direction [W/m2].
  Spectrum sun_irradiance() const;

 private:
  double relative(const Vec3& direction) const;

  const Sky* sky_;
  Spectrum zenith_;  // radiance per relative luminance [W/(m2 sr)]
  Spectrum ground_;
};

}  // namespace reemit::hit_paths
