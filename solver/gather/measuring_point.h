#pragma once
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A point in the air and the way it faces: where irradiance is asked for on a plane that is no part of the
/// room and stands in nobody's light.
struct MeasuringPoint {
  Vec3f place;   ///< [normalised units]
  Vec3f normal;  ///< Unit, towards the side that light is asked for on.
};

/// The point at `place` [m] that faces along `normal` (unit). Coordinates are rounded for rays, so it is
/// moved by two lifts of theirs towards where it faces: a point on a surface is just before it, not behind.
inline MeasuringPoint measuring_point(const RayTracer& rays, const Vec3& place, const Vec3& normal) {
  const Vec3 lifted = rays.normalised_double(place) + 2 * static_cast<double>(RayTracer::kLift) * normal;
  return {lifted.cast<float>(), normal.cast<float>()};
}

}  // namespace reemit
