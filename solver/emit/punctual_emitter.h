#pragma once
#include "scenes/model/luminaire.h"
#include "scenes/model/vec.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// A luminaire without area in the normalised space.
struct PunctualEmitter {
  enum class Kind { kPoint, kSpot, kDirectional };
  Kind kind = Kind::kPoint;
  Vec3f position{0, 0, 0};   ///< Normalised; not used by kDirectional.
  Vec3f direction{0, 0, 1};  ///< Unit, the way the light travels; not used by kPoint.
  float angle_scale = 0;     ///< Spot falloff (cos * scale + offset)^2, clamped to [0,1].
  float angle_offset = 1;

  /// Share of the axial intensity sent along a unit direction, [0,1] (KHR_lights_punctual, "Inner and Outer
  /// Cone Angles").
  float falloff(const Vec3f& away) const;

  /// Irradiance at x with unit normal n per unit of intensity [1/m2], or per unit of irradiance across the
  /// beam for kDirectional, if nothing is in the way: I cos(theta) / r^2 with r in metres.
  float unoccluded_irradiance(const Vec3f& x, const Vec3f& n, float metres_per_unit) const;
};

PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayScene& rays);

/// Intensity [W/sr] on the axis, or irradiance [W/m2] across the beam of a directional light.
const Spectrum& emission_of(const PunctualLight& light);

}  // namespace reemit
