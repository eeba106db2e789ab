#include "viewer_export/still/eye_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "tests/support/hand_made_solution.h"
#include "viewer_export/still/camera.h"

namespace reemit {
namespace {

using test::RoomBuilder;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box of 4 x 3 x 5 m, fronts inside, closed or open towards +z.
RoomBuilder room_of(MaterialId (*wall)(RoomBuilder&), bool open) {
  RoomBuilder room;
  const MaterialId m = wall(room);
  room.box(Vec3(0, 0, 0), Vec3(4, 3, 5), {m, m, m, m, m, open ? MaterialId() : m}, 2);
  return room;
}
MaterialId one_sided(RoomBuilder& room) {
  return room.material("wall", 0.5);
}
MaterialId two_sided(RoomBuilder& room) {
  return room.material("wall", 0.5, 0, true);
}

/// Light on all fronts and on no back.
Solution lit_inside(const RoomBuilder& room) {
  Solution solution = test::uniform_solution(room, 1, 1);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    if (!solution.mesh.zone_is_front(ZoneId(z))) solution.sums.direct[z] = solution.sums.indirect[z] = 0;
  return solution;
}

std::string warning(const RoomBuilder& room, const Vec3& eye, const Vec3& look_at) {
  const Solution solution = lit_inside(room);
  const Room walls(room.scene(), solution.mesh);
  Camera camera;
  camera.eye = eye;
  camera.look_at = look_at;
  return eye_warning(camera, walls, solution);
}

TEST(EyePlace, InsideTheRoomNothingIsSaid) {
  EXPECT_THAT(warning(room_of(one_sided, false), Vec3(2, 1.6, 4), Vec3(2, 1, 0)), IsEmpty());
  EXPECT_THAT(warning(room_of(two_sided, false), Vec3(2, 1.6, 4), Vec3(2, 1, 0)), IsEmpty());
}

TEST(EyePlace, OnAWallItSeesTheRoomBeforeIt) {
  const RoomBuilder room = room_of(two_sided, false);
  const Solution solution = lit_inside(room);
  const Room walls(room.scene(), solution.mesh);
  Camera camera;
  camera.look_at = Vec3(2.1, 1.4, 2.2);
  for (const Vec3& eye :
       {Vec3(2, 1.6, 5), Vec3(1.234567, 0.765432, 5), Vec3(0, 1.5, 2.5), Vec3(4, 0.3, 1.1)}) {
    camera.eye = eye;
    const PinholeCamera pinhole(camera, 8, 8, walls.rays());
    for (int i = 0; i < 64; ++i) {
      const PinholeCamera::Ray ray = pinhole.ray(i % 8 + 0.5, i / 8 + 0.5);
      Hit hit;
      ASSERT_TRUE(walls.rays().closest(ray.origin, ray.direction, hit)) << eye.transpose() << " pixel " << i;
      EXPECT_TRUE(hit.front) << eye.transpose() << " pixel " << i;
      EXPECT_GT(hit.distance, 1e-3F) << eye.transpose() << " pixel " << i;
    }
    EXPECT_THAT(warning(room, eye, camera.look_at), IsEmpty());
  }
}

TEST(EyePlace, BeforeAnOpeningNothingIsSaidNearOrFar) {
  for (const double z : {5.5, 9.0, 40.0})
    EXPECT_THAT(warning(room_of(two_sided, true), Vec3(2, 1.6, z), Vec3(2, 1, 0)), IsEmpty()) << z;
}

TEST(EyePlace, OutsideOfTheRoomIsSaid) {
  for (const double z : {5.5, 9.0, 40.0}) {
    EXPECT_THAT(warning(room_of(two_sided, false), Vec3(2, 1.6, z), Vec3(2, 1, 0)),
                HasSubstr("outside of the room and sees its outer sides"))
        << z;
    EXPECT_THAT(warning(room_of(one_sided, false), Vec3(2, 1.6, z), Vec3(2, 1, 0)),
                HasSubstr("backs of one-sided faces"))
        << z;
  }
}

TEST(EyePlace, InsideOfASolidIsSaid) {
  RoomBuilder room = room_of(two_sided, false);
  const MaterialId m = room.material("block", 0.5, 0, true);
  room.solid(Vec3(1, 0.5, 1), Vec3(2, 1.5, 2), m, 1);
  EXPECT_THAT(warning(room, Vec3(1.5, 1, 1.5), Vec3(3, 1, 3)), HasSubstr("inside of a wall or a solid"));
  EXPECT_THAT(warning(room, Vec3(3, 1, 3), Vec3(1.5, 1, 1.5)), IsEmpty());
}

TEST(EyePlace, ARoomWithoutLightIsNoFaultOfTheCamera) {
  const RoomBuilder room = room_of(two_sided, false);
  const Solution solution = test::dark_solution(room);
  const Room walls(room.scene(), solution.mesh);
  Camera camera;
  camera.eye = Vec3(2, 1.6, 4);
  camera.look_at = Vec3(2, 1, 0);
  EXPECT_THAT(eye_warning(camera, walls, solution), IsEmpty());
}

TEST(EyePlace, AnUnlitRoomIsNotTakenForASolid) {
  // Two rooms, fronts inside; light is in the first alone.
  RoomBuilder room = room_of(two_sided, false);
  const MaterialId m = room.material("wall", 0.5, 0, true);
  room.box(Vec3(5, 0, 0), Vec3(9, 3, 5), {m, m, m, m, m, m}, 2);
  Solution solution = lit_inside(room);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    if (solution.mesh.zone_centroid(ZoneId(z)).x() > 4.5)
      solution.sums.direct[z] = solution.sums.indirect[z] = 0;
  const Room walls(room.scene(), solution.mesh);
  Camera camera;
  camera.eye = Vec3(7, 1.6, 4);
  camera.look_at = Vec3(7, 1, 0);
  EXPECT_THAT(eye_warning(camera, walls, solution), HasSubstr("luminaires do not reach"));
}

TEST(EyePlace, LookingAwayFromTheRoomIsSaid) {
  EXPECT_THAT(warning(room_of(one_sided, false), Vec3(2, 1.6, 60), Vec3(2, 1.6, 70)),
              HasSubstr("nothing of the room"));
}

}  // namespace
}  // namespace reemit
