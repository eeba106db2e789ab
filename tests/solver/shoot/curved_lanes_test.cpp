#include "solver/shoot/curved_lanes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/shoot/packet_room.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

/// Lanes of the zones of a room of round shapes: many of one zone, a few of another, single ones.
TEST(CurvedLanes, RaysLeaveAsOneByOne) {
  test::RoomBuilder builder;
  const MaterialId m = builder.material("walls", 0.5);
  builder.quad(m, {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(3, 3, 0), Vec3(0, 3, 0)}, 2);
  for (const CurvedShape& shape :
       {CurvedShape(Sphere{{0.6, 0.5, 0.9}, 0.2, false}), CurvedShape(Sphere{{1.6, 0.5, 0.9}, 0.2, true}),
        CurvedShape(Disk{{2, 1, 0.7}, Vec3(0.3, -0.5, 0.8).normalized(), 0.3, 0.1}),
        CurvedShape(Cylinder{{0.5, 2, 0.3}, {0.8, 2.1, 1.5}, 0.15, false}),
        CurvedShape(Cone{{1.5, 2, 0.3}, {1.8, 2.1, 1.0}, 0.2, 0.1, true}),
        CurvedShape(Cone{{2.5, 2, 0.3}, {2.4, 2.1, 1.0}, 0.2, 0, false})})
    builder.shape(m, shape, 3);
  const MeshResult built = builder.mesh();
  const Room room(builder.scene(), built.mesh);
  const PacketRoom packets(room);
  const ZoneMesh& mesh = room.mesh();
  const CounterRng rng(9, RngPurpose::kProbe);
  const float last = static_cast<float>(mesh.zone_count()) - 0.5F;
  ZoneLanes lanes{};
  std::size_t curved = 0;
  for (std::uint32_t block = 0; block < 2000; ++block) {
    UniformLanes numbers;
    ZoneId zone[16];
    for (std::uint32_t i = 0; i < 16; ++i) {
      const auto u = rng.uniform4(i, block, 0);
      for (std::size_t d = 0; d < 4; ++d) numbers.u[d][i] = u[d];
      const std::uint32_t piece = i < 8 ? 0 : i < 11 ? 1 : i < 15 ? 2 : 3;
      zone[i] = ZoneId(static_cast<std::uint32_t>(last * rng.uniform4(piece, block, 1)[0]));
      curved += mesh.triangle(mesh.zone_triangle(zone[i])).is_curved() ? 1 : 0;
      packets.put_zone(zone[i], lanes, static_cast<int>(i), static_cast<int>(i) + 1);
    }
    Ray16 rays;
    EXPECT_EQ(packets.start(lanes, numbers, rays), 0U);
    for (int i = 0; i < 16; ++i) {
      Ray16 one;
      const Vec3f local = sample_cosine_hemisphere(numbers.u[2][i], numbers.u[3][i]);
      EXPECT_FALSE(packets.start_from(zone[i], numbers.u[0][i], numbers.u[1][i], local, one, 0));
      EXPECT_LT((rays.origin(i) - one.origin(0)).norm(), 3e-7F) << block << " " << i;
      // Near the horizon the cosine is the root of a small difference.
      EXPECT_LT((rays.direction(i) - one.direction(0)).norm(), 2e-6F / std::max(1e-3F, local.z()));
    }
  }
  EXPECT_GT(curved, 10'000U);
}

}  // namespace
}  // namespace reemit
