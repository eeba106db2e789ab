// What was found at the end of a solve and what is found anew are the same, to the bit.

#include "solver/gather/plan_gathers.h"

#include <atomic>
#include <bit>
#include <limits>

#include <gtest/gtest.h>

#include "solver/gather/caustic_shots.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/radiance_field.h"
#include "solver/progressive_solver.h"
#include "tests/support/never.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

/// A closed room with a lamp that shines down, one that makes a bright spot on the ceiling close above it, a
/// solid, and a small mirror on the floor.
test::RoomBuilder room_with_a_mirror(double mirror_at = 0.2) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.6);
  const MaterialId lamp = room.material("lamp", 0.1, 1);
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, 0.8);
  room.box(Vec3::Zero(), {3, 3, 2.5}, {wall, wall, wall, wall, wall, wall}, 12);
  room.solid({1, 1, 0.01}, {2, 2, 0.8}, wall, 6);
  room.quad(lamp, {Vec3(1, 1, 2.4), Vec3(1, 2, 2.4), Vec3(2, 2, 2.4), Vec3(2, 1, 2.4)}, 2);
  room.quad(lamp, {Vec3(1, 1, 2.45), Vec3(1.4, 1, 2.45), Vec3(1.4, 1.4, 2.45), Vec3(1, 1.4, 2.45)}, 1);
  const double x = mirror_at;
  room.quad(silver, {Vec3(x, .2, .1), Vec3(x + .3, .2, .1), Vec3(x + .3, .5, .1), Vec3(x, .5, .1)}, 1);
  return room;
}

Solution solved_quickly(const test::RoomBuilder& room) {
  SolverSettings settings;
  settings.packets = 2'500;
  return solve(room.scene(), room.mesh(), settings, {}, test::kNever);
}

void expect_same(const CausticShots& a, const CausticShots& b) {
  EXPECT_EQ(a.packets, b.packets);
  for (std::size_t p = 0; p < CausticShots::kParts; ++p) {
    EXPECT_EQ(a.parts[p].places, b.parts[p].places) << p;
    EXPECT_EQ(a.parts[p].normals, b.parts[p].normals) << p;
    EXPECT_EQ(a.parts[p].power, b.parts[p].power) << p;
    EXPECT_EQ(a.parts[p].triangles, b.parts[p].triangles) << p;
    EXPECT_EQ(a.parts[p].luminaires, b.parts[p].luminaires) << p;
    EXPECT_EQ(a.parts[p].radius_codes, b.parts[p].radius_codes) << p;
  }
}

std::size_t zones_continued(const HemisphereGather& gather) {
  std::size_t count = 0;
  for (std::size_t z = 0; z < gather.room().mesh().zone_count(); ++z)
    count += gather.continues(ZoneId(z), std::numeric_limits<float>::max()) ? 1 : 0;
  return count;
}

TEST(PlanGathers, a_solve_ends_with_what_gathers_would_find) {
  const test::RoomBuilder room = room_with_a_mirror();
  const Solution solution = solved_quickly(room);
  const Room walls(room.scene(), solution.mesh);
  const RadianceField field(walls, solution, ZoneSums::kGroups);
  const DirectLight direct(walls);
  const HemisphereGather by_plan(field, direct, {.seed = 99, .plan = &solution.gather_plan});
  const HemisphereGather anew(field, direct, {.seed = solution.settings.seed});
  ASSERT_EQ(solution.gather_plan.uneven.size(), walls.mesh().zone_count());
  for (std::size_t z = 0; z < walls.mesh().zone_count(); ++z)
    EXPECT_EQ(by_plan.continues(ZoneId(z), 1e6F), anew.continues(ZoneId(z), 1e6F)) << z;
  EXPECT_GT(zones_continued(anew), 0U) << "test too weak";

  ASSERT_TRUE(solution.gather_plan.caustics);
  const CausticShooter shooter(walls, solution.settings.seed);
  expect_same(shoot_caustics(shooter, &*solution.gather_plan.caustics, nullptr),
              shoot_caustics(shooter, nullptr, nullptr));
}

TEST(PlanGathers, what_the_plan_says_of_zones_is_done) {
  const test::RoomBuilder room = room_with_a_mirror();
  Solution solution = solved_quickly(room);
  solution.gather_plan.uneven.assign(solution.mesh.zone_count(), 1);
  const Room walls(room.scene(), solution.mesh);
  const RadianceField field(walls, solution, ZoneSums::kGroups);
  const DirectLight direct(walls);
  const HemisphereGather gather(field, direct, {.plan = &solution.gather_plan});
  EXPECT_EQ(zones_continued(gather), solution.mesh.zone_count());
}

TEST(PlanGathers, few_packets_set_out_again) {
  const test::RoomBuilder room = room_with_a_mirror();
  const ZoneMesh mesh = room.mesh().mesh;
  const Room walls(room.scene(), mesh);
  const CausticPackets packets = find_caustic_packets(CausticShooter(walls, 1), nullptr);
  std::size_t marked = 0;
  for (const std::vector<std::uint8_t>& part : packets.brings)
    for (const std::uint8_t byte : part) marked += static_cast<std::size_t>(std::popcount(byte));
  EXPECT_GT(marked, 1000U);
  EXPECT_LT(marked, packets.packets / 10);
  EXPECT_GE(packets.radius_codes.size(), marked);  // a packet can bring more than one
}

TEST(PlanGathers, packets_of_another_room_are_noticed) {
  const test::RoomBuilder room = room_with_a_mirror();
  const test::RoomBuilder other = room_with_a_mirror(2.2);
  const ZoneMesh mesh = room.mesh().mesh;
  const ZoneMesh other_mesh = other.mesh().mesh;
  const Room walls(room.scene(), mesh);
  const Room other_walls(other.scene(), other_mesh);
  const CausticPackets of_other = find_caustic_packets(CausticShooter(other_walls, 1), nullptr);
  const CausticShooter shooter(walls, 1);
  expect_same(shoot_caustics(shooter, &of_other, nullptr), shoot_caustics(shooter, nullptr, nullptr));
}

TEST(PlanGathers, a_run_that_is_stopped_leaves_them_to_others) {
  const test::RoomBuilder room = room_with_a_mirror();
  Solution solution = solved_quickly(room);
  const Room walls(room.scene(), solution.mesh);
  const std::atomic<bool> stopped{true};
  const StopToken stop(stopped);
  plan_uneven_zones(RadianceField(walls, solution, ZoneSums::kGroups), stop, solution);
  plan_caustic_packets(walls, stop, solution);
  EXPECT_TRUE(solution.gather_plan.uneven.empty());
  EXPECT_FALSE(solution.gather_plan.caustics);
}

}  // namespace
}  // namespace reemit
