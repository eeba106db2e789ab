// Rooms that much light leaves are told from those whose few rays that meet nothing may have slipped through
// a hairline.

#include "solver/losses/open_room.h"

#include <atomic>

#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

/// A box of half-grey walls with a bulb, without the lid beyond this share of its width.
test::RoomBuilder box_with_gap(double share) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {wall, wall, wall, wall, wall, MaterialId()}, 2);
  const double end = 1 - share;
  room.quad(wall, {Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(end, 1, 1), Vec3(end, 0, 1)}, 2);
  room.scene().lights = {PointLight{"bulb", Vec3(0.4, 0.6, 0.5), room.flat(1)}};
  return room;
}

TEST(OpenRoom, is_open_where_a_hundredth_of_the_light_leaves) {
  for (const auto& [share, open] : {std::pair{0.0, false}, {0.001, false}, {0.1, true}, {0.9, true}}) {
    const test::RoomBuilder builder = box_with_gap(share);
    const MeshResult built = builder.mesh();
    const Room room(builder.scene(), built.mesh);
    const PacketRoom transport(room);
    EXPECT_EQ(is_open(transport, collect_packet_sources(transport)), open) << share;
    SolverSettings settings;
    settings.packets = 50'000;
    const std::atomic<bool> interrupt = false;
    EXPECT_EQ(is_open(solve_zones(builder.scene(), builder.mesh(), settings, nullptr, interrupt).audit), open)
        << share;
  }
}

TEST(OpenRoom, a_dark_room_is_not) {
  test::RoomBuilder builder = box_with_gap(0.5);
  builder.scene().lights.clear();
  const MeshResult built = builder.mesh();
  const Room room(builder.scene(), built.mesh);
  const PacketRoom transport(room);
  EXPECT_FALSE(is_open(transport, collect_packet_sources(transport)));
}

TEST(OpenRoom, rays_that_meet_nothing_are_believed_when_told_so) {
  test::RoomBuilder builder = box_with_gap(0.5);
  builder.shape(MaterialId(0), Sphere{{0.5, 0.5, 0.5}, 0.1, false}, 1);  // where hairlines may be
  const MeshResult built = builder.mesh();
  Room room(builder.scene(), built.mesh);
  EXPECT_FALSE(room.rays().has_left(RayTracer::kMiss));
  room.believe_misses();
  EXPECT_TRUE(room.rays().has_left(RayTracer::kMiss));
  EXPECT_FALSE(room.rays().has_left(0));
}

}  // namespace
}  // namespace reemit
