// What the sieve claims without rays, against rays.
#include "solver/matrix/blocker_sieve.h"

#include <random>

#include <gtest/gtest.h>

#include "solver/matrix/zone_points.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

TEST(BlockerSieve, OpenPairsAreClearAndHiddenPairsAreBlocked) {
  test::RoomBuilder room;
  const MaterialId m = room.material("all", 0.5);
  const MaterialId screen = room.material("screen", 0.5, 0, true);
  room.box(Vec3::Zero(), Vec3(2, 1, 1), {m, m, m, m, m, m}, 3);
  room.quad(screen, {Vec3(0.8, 0.1, 0), Vec3(1.1, 0.9, 0), Vec3(1.1, 0.9, 0.8), Vec3(0.8, 0.1, 0.8)}, 2);
  const MeshResult meshed = room.mesh();
  const ZoneMesh& mesh = meshed.mesh;
  const RayTracer rays(mesh);
  const BlockerSieve sieve(mesh, 1e-6);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto point = [&](std::size_t z) {
    double u = uniform(random);
    double v = uniform(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return ZonePoints(mesh, rays, ZoneId(z)).origin(static_cast<float>(u), static_cast<float>(v));
  };
  std::size_t count[3] = {};
  for (std::size_t i = 0; i < mesh.zone_count(); ++i)
    for (std::size_t j = i + 1; j < mesh.zone_count(); ++j) {
      const FacingPair pair = facing_parts(zone_polygon(mesh, ZoneId(i)), zone_polygon(mesh, ZoneId(j)));
      if (pair.empty() || pair.a.count > 3 || pair.b.count > 3) continue;  // points are of whole zones
      if (pair.a.area() < 0.999 * mesh.zone_area(ZoneId(i)) ||
          pair.b.area() < 0.999 * mesh.zone_area(ZoneId(j)))
        continue;
      const PairSight sight = sieve.look(i, j, pair);
      ++count[static_cast<std::size_t>(sight)];
      if (sight == PairSight::kUnknown) continue;
      for (int k = 0; k < 24; ++k)
        EXPECT_EQ(rays.visible(point(i), point(j)), sight == PairSight::kOpen) << i << " " << j;
    }
  EXPECT_GT(count[static_cast<std::size_t>(PairSight::kOpen)], 1000U);
  EXPECT_GT(count[static_cast<std::size_t>(PairSight::kHidden)], 100U);
  EXPECT_GT(count[static_cast<std::size_t>(PairSight::kUnknown)], 100U);
}

}  // namespace
}  // namespace reemit
