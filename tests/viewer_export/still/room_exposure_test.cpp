#include "viewer_export/still/room_exposure.h"

#include <atomic>

#include <gtest/gtest.h>

#include "tests/support/hand_made_solution.h"
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

TEST(RoomExposure, IsThatOfAStillFromTheCameraOfTheRoom) {
  const RoomBuilder room = room_with_a_dark_cupboard();
  const Solution solution = darker_in_the_cupboard(room);
  const RayScene rays(solution.mesh);
  const std::atomic<bool> never{false};
  StillSettings settings;
  settings.width = 64;
  settings.height = 64;
  settings.spp = 1;
  settings.integrator = Integrator::kZones;
  const StillImage still =
      render_still(room.scene(), solution, rays, room.scene().cameras.front(), settings, {}, never);
  std::vector<float> rgb;
  for (const float grey : still.radiance) rgb.insert(rgb.end(), 3, grey);
  const ToneMap of_still = make_tone_map(rgb);
  const ToneMap of_room = tone_map_of_room(room.scene(), solution, rays, {});
  EXPECT_NEAR(of_room.exposure_ev(), of_still.exposure_ev(), 0.1);
  EXPECT_NEAR(of_room.white(), of_still.white(), 0.1 * of_still.white());
}

TEST(RoomExposure, WithoutCamerasIsWhatTheAutomaticOnesSee) {
  RoomBuilder room = room_with_a_dark_cupboard();
  const Solution solution = darker_in_the_cupboard(room);
  const RayScene rays(solution.mesh);
  room.scene().lights.push_back(PointLight{"bulb", Vec3(2, 2.5, 2), room.flat(10)});
  const double with_camera = tone_map_of_room(room.scene(), solution, rays, {}).exposure_ev();
  room.scene().cameras.clear();
  EXPECT_NEAR(tone_map_of_room(room.scene(), solution, rays, {}).exposure_ev(), with_camera, 0.1);
}

TEST(RoomExposure, AFixedExposureStays) {
  const RoomBuilder room = room_with_a_dark_cupboard();
  const Solution solution = darker_in_the_cupboard(room);
  const RayScene rays(solution.mesh);
  ToneMapSettings settings;
  settings.exposure_ev = -2;
  const ToneMap tone_map = tone_map_of_room(room.scene(), solution, rays, settings);
  EXPECT_EQ(tone_map.exposure_ev(), -2);
  EXPECT_EQ(tone_map.white(), ToneMapSettings::kFixedWhite);
}

}  // namespace
}  // namespace reemit
