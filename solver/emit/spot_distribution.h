#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/model/luminaire.h"
#include "scenes/model/vec.h"

namespace reemit {

/// The intensity of a spot about its axis: 1 within the inner cone, 0 beyond the outer one, and between them
/// ((cos t - cos outer)/(cos inner - cos outer))^2, as KHR_lights_punctual states it. Direct light, packets
/// and accounts all use this. Works with 1 - cos t, which stays accurate for narrow beams.
class SpotDistribution {
 public:
  explicit SpotDistribution(const SpotLight& spot)
      : inner_(one_minus_cos(spot.inner_angle)),
        outer_(one_minus_cos(spot.outer_angle)),
        full_(inner_),
        total_(full_ + (outer_ - inner_) / 3) {}

  /// Share of the axial intensity [0,1] along a unit direction; `axis` is the unit axis of the spot.
  float share(const Vec3f& axis, const Vec3f& away) const {
    const double v = 0.5 * (away - axis).cast<double>().squaredNorm();
    const double linear = std::clamp((outer_ - v) / (outer_ - inner_), 0.0, 1.0);
    return static_cast<float>(linear * linear);
  }

  /// Integral of the share over all directions [sr]: the ring between the cones counts a third of its solid
  /// angle.
  double solid_angle() const { return 2 * std::numbers::pi * total_; }

  /// Direction about +z with density share/solid_angle per steradian.
  Vec3f sample(float u0, float u1) const {
    const double x = static_cast<double>(u0) * total_;
    // Beyond the inner cone the flux outside of angle t goes with the cube of the linear fall-off.
    const double v =
        x < full_ ? x
                  : outer_ - (outer_ - inner_) * std::cbrt(std::max(0.0, 1 - (x - full_) / (total_ - full_)));
    const double r = std::sqrt(std::max(0.0, v * (2 - v)));
    const double phi = 2 * std::numbers::pi * static_cast<double>(u1);
    return Vec3(r * std::cos(phi), r * std::sin(phi), 1 - v).cast<float>();
  }

 private:
  static double one_minus_cos(double angle) {
    const double s = std::sin(0.5 * angle);
    return 2 * s * s;
  }

  double inner_, outer_;  // 1 - cos of the half angles
  double full_, total_;   // solid angle / 2 pi of the inner cone, and weighted of all
};

}  // namespace reemit
