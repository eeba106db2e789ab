#pragma once
#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "solver/trace/surface_point.h"

namespace reemit::test {

/// The point of the floor, a face in z = 0 that looks to +z, at x, y [m], met from 10 cm above it.
inline SurfacePoint floor_point(const Room& room, double x, double y) {
  const RayTracer& rays = room.rays();
  Hit hit;
  EXPECT_TRUE(rays.closest(rays.normalised(Vec3(x, y, 0.1)), -Vec3f::UnitZ(), hit));
  return surface_point(rays, hit, -Vec3f::UnitZ());
}

}  // namespace reemit::test
