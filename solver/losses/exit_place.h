#pragma once
#include <set>

#include "solver/losses/probe_flight.h"

namespace reemit {

/// Where a ray that met nothing left the room, found by tilting it until it meets something.
struct ExitPlace {
  bool found = false;            ///< Some tilted ray met something.
  Vec3 point{0, 0, 0};           ///< On the rim of the gap or opening [m].
  double width = 0;              ///< Of the gap where it is narrowest, within a factor of about 2 [m].
  std::set<SurfaceId> surfaces;  ///< That make the rim.
};

/// `origin`, unit `direction` [normalised]: of a ray that met nothing. Rays tilted in eight directions about
/// it, more and more up to some 76 degrees, look for the rim; the width is infinite where no two opposite
/// ones meet it. Deterministic.
ExitPlace find_exit(const RayTracer& rays, const Vec3f& origin, const Vec3f& direction);

/// True if nothing, or next to nothing, lies in the half space before the start of a ray that left the room.
bool is_outside(const RayTracer& rays, const Vec3f& origin, const Vec3f& direction);

}  // namespace reemit
