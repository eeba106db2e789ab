#pragma once
#include <cstdint>

#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A point in the air and the way it faces: where irradiance is asked for on a plane that is no part of the
/// room and stands in nobody's light.
struct MeasuringPoint {
  static constexpr std::uint32_t kNoNumber = 0xffffffff;

  Vec3f place;   ///< [normalised units]
  Vec3f normal;  ///< Unit, towards the side that light is asked for on.
  /// Among those that photons are looked out for (GatherSettings::in_air); kNoNumber: it is none of them.
  std::uint32_t number = kNoNumber;
};

/// The point at `place` [m] that faces along `normal` (unit). Coordinates are rounded for rays, so it is
/// moved by two lifts of theirs towards where it faces: a point on a surface is just before it, not behind.
inline MeasuringPoint measuring_point(const RayTracer& rays, const Vec3& place, const Vec3& normal,
                                      std::uint32_t number = MeasuringPoint::kNoNumber) {
  const Vec3 lifted = rays.normalised_double(place) + 2 * static_cast<double>(RayTracer::kLift) * normal;
  return {lifted.cast<float>(), normal.cast<float>(), number};
}

}  // namespace reemit
