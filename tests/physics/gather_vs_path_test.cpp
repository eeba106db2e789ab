#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/sampling/sobol.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;

/// A furnished room of the size of a cupboard: lamp in the ceiling, a shelf that throws a shadow, walls of
/// different reflectance.
RoomBuilder furnished_room(std::uint32_t divisions) {
  RoomBuilder room;
  const MaterialId white = room.material("white", 0.7, 0, true);
  const MaterialId dark = room.material("dark", 0.2, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 20);
  room.box({0, 0, 0}, {1, 1, 1}, {white, dark, white, white, dark, white}, divisions);
  room.quad(lamp, {Vec3(0.3, 0.3, 0.98), Vec3(0.3, 0.6, 0.98), Vec3(0.7, 0.6, 0.98), Vec3(0.7, 0.3, 0.98)},
            divisions / 2);
  room.quad(white, {Vec3(0.1, 0.1, 0.4), Vec3(0.6, 0.1, 0.4), Vec3(0.6, 0.5, 0.4), Vec3(0.1, 0.5, 0.4)},
            divisions);
  return room;
}

/// `kPointCount` points all over the room, corners included; 5 standard errors each leave a right program
/// odds below 1 in 2,000 to fail here.
constexpr std::size_t kPointCount = 24;

SurfacePoint point_number(const RayTracer& rays, std::size_t i) {
  const float u = i % 3 == 0 ? 0.02F : 0.31F;
  const float v = i % 2 == 0 ? 0.04F : 0.45F;
  return surface_point(rays, TriangleId((7 * i) % rays.mesh().triangle_count()), u, v, true);
}

/// Gathered against path-traced indirect irradiance: what is left between them besides noise is the
/// discretisation of the zones, which this bound states.
constexpr double kZoneError = 0.01;

TEST(GatherVsPath, agree_at_points_all_over_a_room) {
  const RoomBuilder room = furnished_room(12);
  SolverSettings settings;
  settings.packets = 3'000'000;
  std::atomic<bool> interrupt{false};
  const Solution solution = solve(room.scene(), room.mesh(), settings, {}, interrupt);
  const Room walls(room.scene(), solution.mesh);
  const RadianceField field(walls, solution);
  const DirectLight direct(walls);
  const HemisphereGather gather(field, direct, {});
  const PathTracer path(walls, direct, 1);
  GatherBatch batch(gather);

  for (std::size_t p = 0; p < kPointCount; ++p) {
    const SurfacePoint x = point_number(walls.rays(), p);
    MeanTest gathered;
    MeanTest traced;
    constexpr std::uint32_t kRays = 512;
    for (std::uint32_t replicate = 0; replicate < 32; ++replicate) {
      const SobolSequence sequence(p * 1000 + replicate);
      const SobolSequence other(p * 1000 + replicate + 500);
      float by_gather = 0;
      float by_path = 0;
      for (std::uint32_t i = 0; i < kRays; ++i) {
        const float weight = std::numbers::pi_v<float> / kRays;
        batch.add(x, sequence.sample(i, 0), sequence.sample(i, 1), {p, replicate, i}, &weight, &by_gather);
        float path_weight = weight;
        path.add_indirect(x, other.sample(i, 0), other.sample(i, 1), {p, replicate, i}, &path_weight,
                          &by_path);
      }
      batch.flush();
      gathered.add(static_cast<double>(by_gather));
      traced.add(static_cast<double>(by_path));
    }
    const double limit = MeanTest::kErrors * std::hypot(gathered.standard_error(), traced.standard_error()) +
                         kZoneError * traced.mean();
    EXPECT_NEAR(gathered.mean(), traced.mean(), limit) << "point " << p;
    EXPECT_LT(MeanTest::kErrors * traced.standard_error(), 0.05 * traced.mean()) << "test too weak";
  }
}

}  // namespace
}  // namespace reemit
