#include "viewer_export/still/default_cameras.h"

#include <gtest/gtest.h>

#include "scenes/io/common/up_direction.h"
#include "solver/room/room.h"
#include "tests/support/test_rooms.h"

namespace reemit::test {
namespace {

std::array<MaterialId, 6> all(MaterialId material) {
  return {material, material, material, material, material, material};
}

/// Nearest distance from the eye to a side of the box; negative outside.
double depth_inside(const Vec3& eye, const Vec3& low, const Vec3& high) {
  return std::min((eye - low).minCoeff(), (high - eye).minCoeff());
}

TEST(DefaultCameras, StandInsideAClosedRoomAndLookDifferentWays) {
  RoomBuilder room;
  const Vec3 low(-3, 0, 1);
  const Vec3 high(2, 2.7, 9);
  room.box(low, high, all(room.material("wall", 0.5)), 2);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> cameras = default_cameras(walls);
  ASSERT_GE(cameras.size(), 2U);
  for (const Camera& camera : cameras) {
    EXPECT_GT(depth_inside(camera.eye, low, high), 0.2) << camera.name;
    EXPECT_NEAR(camera.eye.y(), 1.6, 1e-5) << "a standing person";
    EXPECT_NEAR(camera.look_at.y(), camera.eye.y(), 1e-9) << "level";
  }
  const Vec3 first = (cameras[0].look_at - cameras[0].eye).normalized();
  const Vec3 second = (cameras[1].look_at - cameras[1].eye).normalized();
  EXPECT_LT(first.dot(second), 0.5);
  EXPECT_GT(std::abs(first.z()), 0.7) << "the room is longest along z";
}

TEST(DefaultCameras, AreTheSameEveryTime) {
  RoomBuilder room;
  room.box(Vec3(0, 0, 0), Vec3(4, 3, 5), all(room.material("wall", 0.5)), 2);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> once = default_cameras(walls);
  const std::vector<Camera> again = default_cameras(walls);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].name, again[i].name);
    EXPECT_EQ(once[i].eye, again[i].eye);
    EXPECT_EQ(once[i].look_at, again[i].look_at);
  }
}

TEST(DefaultCameras, StayOutOfFurniture) {
  // A solid block fills the middle of the room: an eye inside it would see backs only.
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3(0, 0, 0), Vec3(6, 3, 6), all(wall), 2);
  const Vec3 block_low(1.5, 0.001, 1.5);
  const Vec3 block_high(4.5, 2.8, 4.5);
  room.solid(block_low, block_high, wall, 1);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  for (const Camera& camera : default_cameras(walls)) {
    EXPECT_LT(depth_inside(camera.eye, block_low, block_high), 0) << camera.name;
    EXPECT_GT(depth_inside(camera.eye, Vec3(0, 0, 0), Vec3(6, 3, 6)), 0) << camera.name;
  }
}

TEST(DefaultCameras, ShowALonePolygonFromItsFront) {
  RoomBuilder room;
  room.quad(room.material("wall", 0.5), {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 1);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> cameras = default_cameras(walls);
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_GT(cameras[0].eye.z(), 0.5);
  EXPECT_LT(cameras[0].look_at.z(), cameras[0].eye.z());
}

TEST(DefaultCameras, LampsThatShineDownTellWhichWayIsUp) {
  // A lamp in the ceiling of a room that has y up, in a format that does not say so.
  RoomBuilder room;
  room.box(Vec3(0, 0, 0), Vec3(3, 3, 3), all(room.material("wall", 0.5)), 1);
  room.quad(room.material("lamp", 0, 10),
            {Vec3(1, 2.9, 1), Vec3(2, 2.9, 1), Vec3(2, 2.9, 2), Vec3(1, 2.9, 2)}, 1);
  room.scene().source = "room.mgf";
  EXPECT_EQ(up_direction(room.scene()), Vec3(0, 1, 0));
  // As much light from a window in a wall: nothing to be learnt.
  room.quad(room.material("window", 0, 10),
            {Vec3(0.1, 1, 1), Vec3(0.1, 2, 1), Vec3(0.1, 2, 2), Vec3(0.1, 1, 2)}, 1);
  EXPECT_EQ(up_direction(room.scene()), Vec3(0, 0, 1));
}

TEST(DefaultCameras, ALampInAWallDoesNotTellWhichWayIsUp) {
  // An MGF room has z up; a panel in its far wall shines along -y, where the room is longer than high.
  RoomBuilder room;
  room.box(Vec3(0, 0, 0), Vec3(4, 6, 3), all(room.material("wall", 0.5)), 1);
  room.quad(room.material("lamp", 0, 10),
            {Vec3(1, 5.9, 1), Vec3(2, 5.9, 1), Vec3(2, 5.9, 2), Vec3(1, 5.9, 2)}, 1);
  room.scene().source = "room.mgf";
  EXPECT_EQ(up_direction(room.scene()), Vec3(0, 0, 1));
}

TEST(DefaultCameras, CamerasOfANativeRoomTellWhichWayIsUp) {
  Scene scene;
  scene.source = "room.json";
  scene.cameras.resize(2);
  scene.cameras[0].up = Vec3(0, 0, 2);
  scene.cameras[1].up = Vec3(0, 0.1, 1);
  EXPECT_EQ(up_direction(scene), Vec3(0, 0, 1));
  scene.cameras[1].up = Vec3(1, 1, 0);
  EXPECT_EQ(up_direction(scene), Vec3(0, 1, 0)) << "they disagree: that of the format";
}

TEST(DefaultCameras, StandWhereLightGoes) {
  // Behind a wall of the lit room lies a longer dark hall: deeper, and closed as well.
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.box(Vec3(0, 0, 0), Vec3(4, 2.7, 3), all(wall), 2);
  room.box(Vec3(4, 0, 0), Vec3(20, 2.7, 8), all(wall), 2);
  room.quad(room.material("lamp", 0, 10),
            {Vec3(1, 2.6, 1), Vec3(2, 2.6, 1), Vec3(2, 2.6, 2), Vec3(1, 2.6, 2)}, 1);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> cameras = default_cameras(walls);
  ASSERT_EQ(cameras.size(), 3U);
  for (const Camera& camera : cameras)
    EXPECT_GT(depth_inside(camera.eye, Vec3(0, 0, 0), Vec3(4, 2.7, 3)), 0.15) << camera.name;
}

TEST(DefaultCameras, KeepClearOfAPartition) {
  // A screen across most of an office; nobody wants a picture of a screen from 10 cm.
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  const MaterialId screen = room.material("screen", 0.5, 0, true);
  room.box(Vec3(0, 0, 0), Vec3(8, 2.7, 6), all(wall), 2);
  for (const double x : {2.0, 4.0, 6.0})
    room.quad(screen, {Vec3(x, 0, 0.8), Vec3(x, 2, 0.8), Vec3(x, 2, 5.2), Vec3(x, 0, 5.2)}, 2);
  room.quad(room.material("lamp", 0, 10),
            {Vec3(1, 2.6, 1), Vec3(7, 2.6, 1), Vec3(7, 2.6, 5), Vec3(1, 2.6, 5)}, 1);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> cameras = default_cameras(walls);
  ASSERT_EQ(cameras.size(), 3U);
  for (const Camera& camera : cameras) {
    const Vec3 forward = (camera.look_at - camera.eye).normalized();
    Hit hit;
    ASSERT_TRUE(walls.rays().closest(walls.rays().normalised(camera.eye), forward.cast<float>(), hit));
    EXPECT_GT(hit.distance * walls.rays().metres_per_unit(), 1.0) << camera.name;
    for (const double x : {2.0, 4.0, 6.0}) {
      const double beside = std::max({0.0, 0.8 - camera.eye.z(), camera.eye.z() - 5.2});
      EXPECT_GT(std::hypot(camera.eye.x() - x, beside), 0.2) << camera.name;
    }
  }
}

TEST(DefaultCameras, AThingWithoutARoomIsInThePicture) {
  RoomBuilder room;
  const MaterialId white = room.material("white", 0.5);
  room.shape(white, Sphere{Vec3(10, 5, -3), 0.5}, 2);
  room.scene().lights.emplace_back(PointLight{"lamp", Vec3(12, 7, -1), room.flat(100)});
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const std::vector<Camera> cameras = default_cameras(walls);
  ASSERT_FALSE(cameras.empty());
  for (const Camera& camera : cameras) {
    const Vec3 forward = (camera.look_at - camera.eye).normalized();
    const Vec3 to_thing = Vec3(10, 5, -3) - camera.eye;
    EXPECT_GT(to_thing.norm(), 0.5) << camera.name;
    EXPECT_GT(forward.dot(to_thing.normalized()), std::cos(0.6)) << camera.name;
  }
}

TEST(DefaultCameras, UpFollowsTheFormat) {
  Scene scene;
  scene.source = "room.MGF";
  EXPECT_EQ(up_direction(scene), Vec3(0, 0, 1));
  scene.source = "room.gltf";
  EXPECT_EQ(up_direction(scene), Vec3(0, 1, 0));
}

}  // namespace
}  // namespace reemit::test
