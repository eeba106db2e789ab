#include "viewer_export/cli/camera_choice.h"

#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "tests/support/test_rooms.h"

namespace reemit::cli {
namespace {

TEST(CameraChoice, AnEyeWithoutUpStandsAsAutomaticCamerasDo) {
  // A cube whose lamp shines along -y.
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3(0, 0, 0), Vec3(3, 3, 3), {wall, wall, wall, wall, wall, wall}, 1);
  room.quad(room.material("lamp", 0, 10),
            {Vec3(1, 2.9, 1), Vec3(2, 2.9, 1), Vec3(2, 2.9, 2), Vec3(1, 2.9, 2)}, 1);
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  CameraOptions options;
  options.eye = Vec3(0.5, 0.5, 0.5);
  options.look_at = Vec3(2, 1, 1);
  room.scene().source = "room.mgf";
  EXPECT_EQ(choose_cameras(options, walls, false).front().up, Vec3(0, 1, 0));
  room.scene().source = "room.json";
  EXPECT_EQ(choose_cameras(options, walls, false).front().up, Vec3(0, 1, 0));
  room.scene().cameras.emplace_back().up = Vec3(0, 0, 1);
  EXPECT_EQ(choose_cameras(options, walls, false).front().up, Vec3(0, 0, 1)) << "all cameras say so";
  room.scene().cameras.clear();
  room.scene().sky = Sky();
  room.scene().sky->up = Vec3(0, 0, 1);
  EXPECT_EQ(choose_cameras(options, walls, false).front().up, Vec3(0, 0, 1)) << "the sky says so";
  options.up = Vec3(1, 0, 0);
  EXPECT_EQ(choose_cameras(options, walls, false).front().up, Vec3(1, 0, 0));
}

}  // namespace
}  // namespace reemit::cli
