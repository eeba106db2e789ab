#pragma once
#include <memory>
#include <optional>

#include "scenes/model/luminaire.h"
#include "scenes/model/vec.h"
#include "solver/emit/photometric_emitter.h"
#include "solver/emit/spot_distribution.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// A luminaire that rays do not see, in the normalised space.
struct PunctualEmitter {
  enum class Kind { kPoint, kSpot, kDirectional, kPhotometric };
  Kind kind = Kind::kPoint;
  Vec3f position{0, 0, 0};               ///< Normalised; not used by kDirectional.
  Vec3f direction{0, 0, 1};              ///< Unit, the way the light travels; of kSpot and kDirectional.
  std::optional<SpotDistribution> spot;  ///< Of kSpot.
  std::shared_ptr<const PhotometricEmitter> photometric;  ///< Of kPhotometric.

  /// Irradiance at x with unit normal n per unit of emission_of (so [1/m2] for an intensity, [1] for
  /// kDirectional) if nothing is in the way: I cos(theta) / r^2 with r in metres. For kPhotometric, whose
  /// light comes from many points, about that (PhotometricEmitter::expected_irradiance). 0 only if the
  /// luminaire cannot light x.
  float unoccluded_irradiance(const Vec3f& x, const Vec3f& n, float metres_per_unit) const;

  /// The point that lights x, drawn by u0, u1 where there are many. The mean of the factor over u0, u1 is the
  /// irradiance if nothing is in the way.
  PunctualSample sample(const Vec3f& x, const Vec3f& n, float u0, float u1, float metres_per_unit) const;
};

PunctualEmitter make_punctual_emitter(const PunctualLight& light, const RayScene& rays);

/// Intensity [W/sr] on the axis, irradiance [W/m2] across the beam of a directional light, or intensity per
/// candela of a measured luminaire.
const Spectrum& emission_of(const PunctualLight& light);

}  // namespace reemit
