#pragma once
#include <memory>
#include <optional>
#include <span>

#include "scenes/model/luminaire.h"
#include "solver/emit/light_ray.h"
#include "solver/emit/luminaire_bounds.h"
#include "solver/emit/luminaire_sample.h"
#include "solver/emit/opening_sampler.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A measured luminaire in the normalised space, as PunctualEmitter asks every kind. Every point of the
/// opening sends out the distribution of the table, so irradiance is the mean of I cos/r^2 over the opening
/// at every distance: there is no distance at which a point takes over, and so no seam.
class PhotometricEmitter {
 public:
  using Light = PhotometricLight;
  static constexpr bool kAtInfinity = false;

  PhotometricEmitter(const Light& light, const RayTracer& rays);

  static const Spectrum& strength(const Light& light) { return light.intensity_per_candela; }
  static Spectrum power(const Light& light, double /*metres_per_unit*/) {
    return light.table->total_flux() * light.intensity_per_candela;
  }

  /// About the irradiance at x (normal n) per unit of intensity_per_candela [cd/m2] if nothing is in the way,
  /// by IntensityTable::rough_intensity from the middle of the opening, or from a few of its points if it is
  /// near or its middle lies below the horizon. Above 0 wherever a point of the opening
  /// lies above the horizon of x.
  float expected_irradiance(const Vec3f& x, const Vec3f& n) const;

  /// A point of the opening for two uniform numbers: factor = I cos/r^2 [cd/m2], r in metres. Within
  /// kNearest of the size of the opening r counts as that much.
  LuminaireSample sample(const Vec3f& x, const Vec3f& n, float u0, float u1) const;

  LuminaireBounds bounds(float strength) const;
  /// Just outside the opening, in the mean direction of the light.
  Vec3f mouth() const;
  LightRay start_ray(float u0, float u1, float u2, float u3) const;
  /// As many of them as there are, 16 at most, for much less each.
  void start_rays(const LightNumbers& u, std::span<LightRay> rays) const;

  /// Distance, in sizes of the opening, below which irradiance grows no more. A homogeneous opening says
  /// nothing about what is that close, and without a bound the irradiance of a surface that touches it at a
  /// right angle is infinite.
  static constexpr double kNearest = 1e-3;
  /// Rays start, and shadow rays end, that far off the opening [normalised], so that an opening in the plane
  /// of a ceiling shines out of it.
  static constexpr double kClear = 1e-5;

 private:
  Vec3 point(double u0, double u1) const;  // normalised
  LightRay ray(const Vec3& from, const Vec3& direction_in_luminaire) const;
  /// cos / r^2 for a point of the opening, 0 below the horizon [1/m2].
  double geometry(const Vec3& to_light, const Vec3& n) const;
  Vec3 in_luminaire(const Vec3& direction) const { return data_->to_room.transpose() * direction; }

  struct Data {
    std::shared_ptr<const IntensityTable> table;
    LuminousOpening opening;
    Vec3 centre;                      // normalised
    Eigen::Matrix3d to_room;          // luminaire coordinates to the room
    double metres;                    // per normalised unit
    double nearest2;                  // [normalised units^2]
    double extent2;                   // [normalised units^2]
    std::optional<FlatOpening> flat;  // the opening, normalised, if it is flat
  };
  std::shared_ptr<const Data> data_;  // aside: it is large, and tables of luminaires should stay in cache
};

}  // namespace reemit
