// Closed rooms lose nothing: not a quantum leaves them, meets the back of a one-sided face or reaches a
// sealed body, whatever pierces their walls or stands on their floors. Counts of quanta, so no tolerance;
// each room leaked by many packets when its zones could lie on two sides of a face.

#include <atomic>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

const std::string kHall = R"(
  {"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true}},
  {"name": "lamp", "material": "lamp", "quad": {"corner": [1.5, 2.9, 2], "u": [1, 0, 0], "v": [0, 0, 1]}})";

Scene room_of(const std::string& objects, const std::string& more = "") {
  const test::TempFolder folder;
  return read_scene(folder.write("room.json", R"({"format": "reemit-room", "version": 1, "materials": {
    "wall": {"reflectance": 0.5}, "sealed": {"reflectance": 0.5}, "one": {"reflectance": 0.5, "sides": "front"},
    "lamp": {"reflectance": 0.5, "radiance": 10}}, "objects": [)" +
                                                  objects + "]" + more + "}"));
}

Solution solve_room(const Scene& scene, SolveMethod method, double zone_area) {
  SolverSettings settings;
  settings.method = method;
  settings.packets = 100'000;
  settings.gather_small_zones = false;
  settings.threads = 2;
  MeshSettings mesh;
  if (zone_area > 0) mesh.zone_area = zone_area;
  const std::atomic<bool> interrupt = false;
  return solve_zones(scene, build_mesh(scene, mesh), settings, nullptr, interrupt);
}

void expect_nothing_lost(const Scene& scene) {
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk})
    for (const double zone_area : {0.0, 1.0}) {
      const Solution s = solve_room(scene, method, zone_area);
      const BandAudit& audit = s.audit.bands.at(0);
      EXPECT_GT(audit.emitted, 0);
      EXPECT_EQ(audit.total_escaped(), 0);
      const auto& backs = audit.absorbed_on_backs;
      EXPECT_EQ(std::accumulate(backs.begin(), backs.end(), std::int64_t{0}), 0);
      for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
        if (scene.material_of(scene.surfaces[i]).name != "sealed") continue;
        EXPECT_EQ(audit.absorbed[i], 0) << scene.surfaces[i].name;
      }
    }
}

TEST(ClosedRooms, RodsAndBarsThroughTheWalls) {
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "rod", "material": "wall", "cylinder": {"base": [1, 0.43, 2], "top": [1, 0.43, 5.5], "radius": 0.01}},
    {"name": "bar", "material": "wall", "box": {"min": [3, 0.43, 2], "max": [3.02, 0.45, 12]}})"));
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "slanted", "material": "wall", "cylinder": {"base": [1, 0.4, 2], "top": [1.3, 0.9, 7], "radius": 0.02}},
    {"name": "down", "material": "wall", "cylinder": {"base": [3, 1, 4], "top": [3.3, -1, 4.4], "radius": 0.02}},
    {"name": "plate", "material": "wall", "box": {"min": [0.5, 2, 4], "max": [3.5, 2.002, 7]}},
    {"name": "corner", "material": "wall", "box": {"min": [3.5, 0.43, 4.5], "max": [4.5, 0.45, 5.5]}})"));
}

// Where a rod becomes flat faces, its caps must too, or they stick out between its corners.
TEST(ClosedRooms, CapsOfRodsThroughTheWallsEndWhereTheRodsDo) {
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "rod", "material": "one", "cylinder": {"base": [1, 0.6, 2], "top": [1, 0.6, 5.5], "radius": 0.4}},
    {"name": "hopper", "material": "one", "cylinder": {"base": [3, 0.8, 2], "top": [3, 0.8, 5.5], "radius": 0.7, "top_radius": 0.3}})"));
}

TEST(ClosedRooms, RodFromALitRoomIntoADarkOne) {
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "next room", "material": "sealed", "box": {"min": [0, 0, 5.2], "max": [4, 3, 9], "inward": true}},
    {"name": "rod", "material": "wall", "cylinder": {"base": [1, 0.43, 2], "top": [1.3, 0.6, 8], "radius": 0.01}},
    {"name": "bar", "material": "wall", "box": {"min": [3, 1, 4], "max": [3.02, 1.02, 8]}})"));
}

// The foot of the tower reaches 7 mm beyond the polygon that the floor is cut along.
TEST(ClosedRooms, RoundTowersAndConesAreSealed) {
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "tower", "material": "wall", "cylinder": {"base": [1.5, 0, 3], "top": [1.5, 2.5, 3], "radius": 1.4, "caps": "top"}},
    {"name": "in the tower", "material": "sealed", "box": {"min": [1, 1, 2.5], "max": [2, 1.5, 3.5]}})"));
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "cone", "material": "wall", "cylinder": {"base": [1.5, 0, 3], "top": [1.5, 2.5, 3], "radius": 1.4, "top_radius": 0, "caps": "none"}},
    {"name": "in the cone", "material": "sealed", "box": {"min": [1.3, 0.5, 2.8], "max": [1.7, 0.6, 3.2]}})"));
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "pillar", "material": "wall", "cylinder": {"base": [2, 0, 4], "top": [2, 3, 4], "radius": 0.9, "caps": "none"}},
    {"name": "in the pillar", "material": "sealed", "box": {"min": [1.5, 1, 3.7], "max": [2.5, 2, 4.3]}})"));
}

TEST(ClosedRooms, SpheresAndLogsInTheFloor) {
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "half", "material": "wall", "sphere": {"center": [1, 0, 1], "radius": 0.6}},
    {"name": "0.1 mm deep", "material": "wall", "sphere": {"center": [3, 0.6999, 1], "radius": 0.7}},
    {"name": "stands", "material": "wall", "sphere": {"center": [2, 0.5, 4], "radius": 0.5}},
    {"name": "in it", "material": "sealed", "box": {"min": [1.8, 0.3, 3.8], "max": [2.2, 0.7, 4.2]}})"));
  expect_nothing_lost(room_of(kHall + R"(,
    {"name": "half", "material": "wall", "cylinder": {"base": [1, 0, 1], "top": [1, 0, 4], "radius": 0.4}},
    {"name": "0.1 mm deep", "material": "wall", "cylinder": {"base": [3, 0.2999, 1], "top": [3, 0.2999, 4], "radius": 0.3}})"));
}

TEST(ClosedRooms, LightsWithoutAnAreaOnWallsAndInCorners) {
  const std::string hull =
      R"({"name": "hull", "material": "%", "box": {"min": [0, 0, 0], "max": [4, 3, 5], "inward": true}})";
  for (const std::string material : {"wall", "one"})
    for (const std::string position : {"[0, 1, 1]", "[0, 0, 5]", "[-5e-6, 1, 1]"}) {
      SCOPED_TRACE(material + " " + position);
      std::string hull_of = hull;
      hull_of.replace(hull_of.find('%'), 1, material);
      expect_nothing_lost(room_of(
          hull_of, R"(, "lights": [{"type": "point", "position": )" + position + R"(, "power": 10}])"));
    }
}

}  // namespace
}  // namespace reemit
