#pragma once
#include <numbers>
#include <variant>

#include "solver/reflect/lambert.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Value of a BRDF at two directions: tint[b] * per_sr [1/sr] in band b.
struct BrdfValue {
  const float* tint;  ///< One value per band.
  float per_sr;

  float operator()(std::size_t band) const { return tint[band] * per_sr; }
};

/// A direction in which light goes on, or comes from.
struct ScatterSample {
  Vec3f direction;        ///< Unit.
  float cosine_over_pdf;  ///< Cosine to the normal over the density of the direction [sr].
};

/// lambert.h as a lobe.
struct LambertLobe {
  const float* reflectance;  ///< One value per band [0,1].

  BrdfValue value(const SurfacePoint& /*x*/, const Vec3f& /*from*/) const {
    return {reflectance, std::numbers::inv_pi_v<float>};
  }
  ScatterSample sample(const SurfacePoint& x, float u0, float u1) const {
    return {sample_lambert(x.normal, u0, u1), std::numbers::pi_v<float>};
  }
};

/// All ways in which surfaces scatter light; each has the members of LambertLobe.
using Lobe = std::variant<LambertLobe>;

}  // namespace reemit
