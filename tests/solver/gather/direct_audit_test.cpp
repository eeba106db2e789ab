#include "solver/gather/direct_audit.h"

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/never.h"
#include "tests/support/shelf_room.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::kNever;
using test::room_with_shelf;

Solution solved(const test::RoomBuilder& room, DirectSource direct = DirectSource::kPackets) {
  SolverSettings settings;
  settings.direct = direct;
  settings.packets = 2'000'000;
  return solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
}

TEST(DirectAudit, packets_and_shadow_rays_find_the_same_direct_light) {
  const test::RoomBuilder room = room_with_shelf();
  for (const DirectSource direct : {DirectSource::kPackets, DirectSource::kBest}) {
    const Solution solution = solved(room, direct);
    const Room walls(room.scene(), solution.mesh);
    const DirectAudit audit = audit_direct_light(walls, solution, {}, {}, kNever);
    EXPECT_EQ(audit.compared + audit.left_out, solution.mesh.zone_count());
    EXPECT_GT(audit.compared, 500U);
    EXPECT_TRUE(audit.agrees()) << audit.different.size() << " zones differ";
  }
}

TEST(DirectAudit, a_bias_of_2_percent_on_one_surface_is_noticed) {
  const test::RoomBuilder room = room_with_shelf();
  Solution solution = solved(room);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    if (solution.mesh.zone_surface(ZoneId(z)) == SurfaceId(4)) solution.sums.direct[z] *= 1.02;
  const Room walls(room.scene(), solution.mesh);
  const DirectAudit audit = audit_direct_light(walls, solution, {}, {}, kNever);
  EXPECT_FALSE(audit.agrees());
  for (std::size_t s = 0; s < audit.surfaces.size(); ++s)
    EXPECT_EQ(audit.surfaces[s].differs(), s == 4) << "surface " << s;
}

TEST(DirectAudit, a_single_dark_zone_is_found) {
  const test::RoomBuilder room = room_with_shelf();
  Solution solution = solved(room);
  const ZoneId dark(solution.mesh.first_zone(TriangleId(8), true).index() + 5);
  solution.sums.direct[dark.index()] = 0;
  const Room walls(room.scene(), solution.mesh);
  const DirectAudit audit = audit_direct_light(walls, solution, {}, {}, kNever);
  ASSERT_EQ(audit.different.size(), 1U);
  EXPECT_EQ(audit.different[0].zone, dark);
}

TEST(DirectAudit, a_solution_without_packets_is_refused) {
  const test::RoomBuilder room = room_with_shelf();
  Solution solution = solved(room);
  solution.record.packets = 0;
  const Room walls(room.scene(), solution.mesh);
  EXPECT_THROW(audit_direct_light(walls, solution, {}, {}, kNever), InputError);
}

}  // namespace
}  // namespace reemit
