#include "viewer_export/still/room_exposure.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/never.h"
#include "viewer_export/cli/camera_choice.h"
#include "viewer_export/still/default_cameras.h"
#include "viewer_export/still/render_still.h"

namespace reemit {
namespace {

using test::RoomBuilder;

/// A room of even light, and behind its wall a cupboard that is a thousand times darker and has far more
/// zones.
RoomBuilder room_with_a_dark_cupboard() {
  RoomBuilder room;
  const MaterialId white = room.material("white", 0.6);
  const std::array<MaterialId, 6> walls{white, white, white, white, white, white};
  room.box(Vec3(0, 0, 0), Vec3(4, 3, 5), walls, 2);
  room.box(Vec3(5, 0, 0), Vec3(6, 3, 5), walls, 24);
  Camera camera;
  camera.name = "door";
  camera.eye = Vec3(0.5, 1.6, 4.5);
  camera.look_at = Vec3(3, 1, 1);
  room.scene().cameras.push_back(camera);
  return room;
}

Solution darker_in_the_cupboard(const RoomBuilder& room) {
  Solution solution = test::uniform_solution(room, 100, 50);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    if (solution.mesh.zone_centroid(ZoneId(z)).x() > 4.5) {
      solution.sums.direct[z] *= 1e-3;
      solution.sums.indirect[z] *= 1e-3;
      solution.sums.group_total[z] *= 1e-3;
    }
  return solution;
}

using test::kNever;

ToneMap of_still(const Room& room, const Solution& solution, const Camera& camera) {
  StillSettings settings;
  settings.width = 160;
  settings.height = std::max(1, 160 * camera.height / camera.width);
  settings.spp = 16;
  return make_tone_map(rgb_of(render_still(room, solution, camera, settings, {}, kNever)));
}

TEST(RoomExposure, IsThatOfTheStillFromTheFirstCamera) {
  RoomBuilder room = room_with_a_dark_cupboard();
  Camera cupboard = room.scene().cameras.front();
  cupboard.name = "cupboard";
  cupboard.eye = Vec3(5.5, 1.6, 4.5);
  cupboard.look_at = Vec3(5.5, 1, 1);
  room.scene().cameras.push_back(cupboard);
  const Solution solution = darker_in_the_cupboard(room);
  const Room walls(room.scene(), solution.mesh);
  const ToneMap still = of_still(walls, solution, room.scene().cameras.front());
  const ToneMap of_room = tone_map_of_room(walls, solution, {}, 0, kNever);
  EXPECT_NEAR(of_room.exposure_ev(), still.exposure_ev(), 0.1);
  EXPECT_NEAR(of_room.white(), still.white(), 0.1 * still.white());
}

TEST(RoomExposure, WithoutCamerasIsThatOfTheFirstAutomaticOne) {
  RoomBuilder room = room_with_a_dark_cupboard();
  room.scene().lights.push_back(PointLight{"bulb", Vec3(2, 2.5, 2), room.flat(10)});
  room.scene().cameras.clear();
  const Solution solution = darker_in_the_cupboard(room);
  const Room walls(room.scene(), solution.mesh);
  const ToneMap still = of_still(walls, solution, default_cameras(walls).front());
  const ToneMap of_room = tone_map_of_room(walls, solution, {}, 0, kNever);
  EXPECT_NEAR(of_room.exposure_ev(), still.exposure_ev(), 0.1);
}

/// Of rooms as they are: an export and the still that is made without asking for a camera.
void expect_an_export_as_bright_as_the_still(const std::filesystem::path& file) {
  const Scene scene = read_scene(file);
  const MeshResult mesh = build_zones(scene, {.default_zone_count = 2'000});
  SolverSettings settings;
  settings.packets = 400'000;
  const Solution solution = solve_zones(scene, mesh, settings, {}, kNever);
  const Room walls(scene, solution.mesh);
  const Camera camera = cli::cameras_of(walls).front();
  const double still = of_still(walls, solution, camera).exposure_ev();
  EXPECT_NEAR(tone_map_of_room(walls, solution, {}, 0, kNever).exposure_ev(), still, 0.2) << file;
}

const std::filesystem::path kSource = REEMIT_SOURCE_DIR;

TEST(RoomExposure, OfTheCornellBoxIsThatOfItsStill) {
  expect_an_export_as_bright_as_the_still(kSource / "scenes/library/cornell_box.json");
}

TEST(RoomExposure, OfTheOfficeIsThatOfItsStill) {
  expect_an_export_as_bright_as_the_still(kSource / "scenes/library/office.json");
}

TEST(RoomExposure, OfTheConferenceRoomIsThatOfItsStill) {
  const std::filesystem::path room = kSource / "../shared/scenes/mgf/conference_1994/conf.mgf";
  if (!std::filesystem::exists(room)) GTEST_SKIP() << room << " is not here";
  expect_an_export_as_bright_as_the_still(room);
}

TEST(RoomExposure, AFixedExposureStays) {
  const RoomBuilder room = room_with_a_dark_cupboard();
  const Solution solution = darker_in_the_cupboard(room);
  const Room walls(room.scene(), solution.mesh);
  ToneMapSettings settings;
  settings.exposure_ev = -2;
  const ToneMap tone_map = tone_map_of_room(walls, solution, settings, 0, kNever);
  EXPECT_EQ(tone_map.exposure_ev(), -2);
  EXPECT_EQ(tone_map.white(), ToneMapSettings::kFixedWhite);
}

}  // namespace
}  // namespace reemit
