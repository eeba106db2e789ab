#include <numbers>

#include <gtest/gtest.h>

#include "scenes/io/common/surface_geometry.h"
#include "tests/scenes/io/native_reading.h"

namespace reemit {
namespace {

using test::expect_refused;
using test::read_text;
using test::room;
using test::room_of;

Vec3 area_vector(const Surface& surface, const Face& face) {
  Vec3 twice = Vec3::Zero();
  const Vec3& origin = surface.positions[face.outer[0]];
  for (std::size_t i = 1; i + 1 < face.outer.size(); ++i) {
    twice += (surface.positions[face.outer[i]] - origin).cross(surface.positions[face.outer[i + 1]] - origin);
  }
  return 0.5 * twice;
}

/// Of the solid whose boundary the surface is, fronts outwards; negative when they look inwards.
double volume(const Surface& surface) {
  double volume = 0;
  for (const Face& face : surface.faces) {
    volume += surface.positions[face.outer[0]].dot(area_vector(surface, face)) / 3;
  }
  return volume;
}

Surface only_surface(const std::string& object) {
  const Scene scene = read_text(room_of(object));
  EXPECT_EQ(scene.surfaces.size(), 1u);
  return scene.surfaces.at(0);
}

/// Shading normals must be unit vectors on the side the faces look to.
void expect_normals_outside(const Surface& surface) {
  for (const Face& face : surface.faces) {
    for (const std::uint32_t normal : face.normals) {
      EXPECT_NEAR(surface.normals[normal].norm(), 1, 1e-12);
      EXPECT_GT(surface.normals[normal].dot(area_vector(surface, face)), 0);
    }
  }
}

TEST(NativeShapes, BoxLooksOutwardsOrInwards) {
  const Surface box = only_surface(R"({"material": "white", "box": {"min": [1, 2, 3], "max": [3, 3, 6]}})");
  EXPECT_NEAR(volume(box), 6, 1e-12);
  EXPECT_NEAR(surface_area(box), 22, 1e-12);
  const Surface room =
      only_surface(R"({"material": "white", "box": {"min": [1, 2, 3], "max": [3, 3, 6], "inward": true}})");
  EXPECT_NEAR(volume(room), -6, 1e-12);
  const Surface flipped =
      only_surface(R"({"material": "white", "flip": true, "box": {"min": [1, 2, 3], "max": [3, 3, 6]}})");
  EXPECT_NEAR(volume(flipped), -6, 1e-12);
}

TEST(NativeShapes, BoxLeavesOutOpenFacesAndTakesMaterialsPerFace) {
  const Scene scene = read_text(room_of(R"({"name": "b", "material": "white", "materials": {"y-": "lamp"},
      "box": {"min": [0, 0, 0], "max": [1, 1, 1], "open": ["y+", "x-"]}})"));
  ASSERT_EQ(scene.surfaces.size(), 4u);
  for (const Surface& side : scene.surfaces) {
    EXPECT_EQ(scene.material_of(side).name, side.name == "b/y-" ? "lamp" : "white") << side.name;
    EXPECT_NE(side.name, "b/y+");
  }
  EXPECT_NEAR(area_vector(scene.surfaces[1], scene.surfaces[1].faces[0]).y(), -1, 1e-12);
}

TEST(NativeShapes, SphereConvergesToItsVolume) {
  const Surface sphere = only_surface(
      R"({"material": "white", "sphere": {"center": [5, 0, 0], "radius": 2, "segments": 128, "rings": 64}})");
  EXPECT_NEAR(volume(sphere) / (4.0 / 3 * std::numbers::pi * 8), 1, 3e-3);
  expect_normals_outside(sphere);
  for (const Vec3& p : sphere.positions) EXPECT_NEAR((p - Vec3(5, 0, 0)).norm(), 2, 1e-12);
}

TEST(NativeShapes, CylinderAndConeAreClosedAndLookOutwards) {
  const Surface cylinder = only_surface(
      R"({"material": "white", "cylinder": {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1, "segments": 256}})");
  EXPECT_NEAR(volume(cylinder), 3 * std::numbers::pi, 1e-3);
  expect_normals_outside(cylinder);
  const Surface cone = only_surface(R"({"material": "white",
      "cylinder": {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1, "top_radius": 0, "segments": 256}})");
  EXPECT_NEAR(volume(cone), std::numbers::pi, 1e-3);
  expect_normals_outside(cone);
  const Surface frustum = only_surface(R"({"material": "white", "cylinder":
      {"base": [0, 0, 0], "top": [3, 0, 0], "radius": 2, "top_radius": 1, "segments": 256, "inward": true}})");
  EXPECT_NEAR(volume(frustum), -std::numbers::pi * 7, 1e-2);
  const Surface tube = only_surface(R"({"material": "white", "cylinder":
      {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1, "segments": 8, "caps": "none"}})");
  EXPECT_EQ(tube.faces.size(), 8u);
}

TEST(NativeShapes, RoundShapesStayWhatTheyAreWithoutSegments) {
  const Surface sphere = only_surface(
      R"({"material": "white", "sphere": {"center": [5, 0, 0], "radius": 2, "inward": true}, "flip": true})");
  EXPECT_TRUE(sphere.faces.empty());
  EXPECT_FALSE(std::get<Sphere>(sphere.shapes.at(0)).inward) << "turned twice";
  EXPECT_NEAR(surface_area(sphere), 16 * std::numbers::pi, 1e-12);
  const Surface can = only_surface(
      R"({"material": "white", "cylinder": {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1}})");
  ASSERT_EQ(can.shapes.size(), 3U);
  EXPECT_NEAR(surface_area(can), 8 * std::numbers::pi, 1e-12);
  EXPECT_EQ(std::get<Disk>(can.shapes[1]).normal, Vec3(0, -1, 0));
  const Surface inside = only_surface(
      R"({"material": "white", "cylinder": {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1, "inward": true}})");
  EXPECT_TRUE(std::get<Cylinder>(inside.shapes[0]).inward);
  EXPECT_EQ(std::get<Disk>(inside.shapes[1]).normal, Vec3(0, 1, 0));
  const Surface cone = only_surface(R"({"material": "white", "cylinder":
      {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 1, "top_radius": 0, "caps": "none"},
      "transform": {"scale": 2}})");
  EXPECT_EQ(std::get<Cone>(cone.shapes.at(0)).base_radius, 2);
  EXPECT_THROW(only_surface(R"({"material": "white", "sphere": {"center": [0, 0, 0], "radius": 1},
      "transform": {"scale": [1, 2, 1]}})"),
               InputError);
}

TEST(NativeShapes, DiskHasAHoleAndLooksAlongItsNormal) {
  const Surface ring = only_surface(R"({"material": "white",
      "disk": {"center": [0, 1, 0], "normal": [0, -2, 0], "radius": 2, "inner_radius": 1, "segments": 512}})");
  EXPECT_NEAR(surface_area(ring), 3 * std::numbers::pi, 1e-3);
  EXPECT_LT(area_vector(ring, ring.faces[0]).y(), 0);
  ASSERT_EQ(ring.faces[0].holes.size(), 1u);
}

TEST(NativeShapes, PolygonKeepsHolesAndMeshKeepsIndices) {
  const Surface polygon = only_surface(R"({"material": "white", "polygon": {
      "vertices": [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]],
      "holes": [[[1, 1, 0], [1, 2, 0], [2, 2, 0], [2, 1, 0]]]}})");
  EXPECT_NEAR(surface_area(polygon), 15, 1e-12);
  const Surface mesh = only_surface(
      R"({"material": "white", "mesh": {"vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], "faces": [[0,1,2],[0,2,3]]}})");
  EXPECT_EQ(mesh.faces[1].outer, (std::vector<std::uint32_t>{0, 2, 3}));
  expect_refused(
      room_of(
          R"({"material": "white", "mesh": {"vertices": [[0,0,0],[1,0,0],[1,1,0]], "faces": [[0,1,3]]}})"),
      {"#/objects/0/mesh/faces/0/2", "no vertex 3", "3 vertices", "0 to 2"});
}

TEST(NativeObjects, UnitScalesEverything) {
  const Scene scene = read_text(room(R"("unit": "cm", "materials": {"white": {"reflectance": 0.5}},
      "objects": [{"material": "white", "quad": {"corner": [0, 0, 0], "u": [200, 0, 0], "v": [0, 300, 0]},
                   "transform": {"translate": [0, 0, 50]}}],
      "lights": [{"type": "point", "position": [100, 0, 0], "intensity": 1}],
      "cameras": [{"eye": [0, 100, 0], "look_at": [0, 100, 100]}])"));
  EXPECT_NEAR(surface_area(scene.surfaces[0]), 6, 1e-12);
  EXPECT_NEAR(scene.surfaces[0].positions[0].z(), 0.5, 1e-15);
  EXPECT_NEAR(std::get<PointLight>(scene.lights[0]).position.x(), 1, 1e-15);
  EXPECT_NEAR(scene.cameras[0].eye.y(), 1, 1e-15);
}

TEST(NativeObjects, TransformsApplyInOrder) {
  const Surface quad =
      only_surface(R"({"material": "white", "quad": {"corner": [1, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]},
      "transform": [{"scale": [2, 1, 1]}, {"rotate": {"axis": [0, 0, 3], "angle_deg": 90}}, {"translate": [10, 0, 0]}]})");
  // (1,0,0) -> (2,0,0) -> (0,2,0) -> (10,2,0), exactly: a quarter turn must not leave the plane.
  EXPECT_EQ(quad.positions[0], Vec3(10, 2, 0));
  const Surface about =
      only_surface(R"({"material": "white", "quad": {"corner": [1, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]},
      "transform": {"rotate": {"axis": [0, 1, 0], "angle_deg": 180, "about": [2, 0, 0]}}})");
  EXPECT_EQ(about.positions[0], Vec3(3, 0, 0));
  const Surface matrix =
      only_surface(R"({"material": "white", "quad": {"corner": [1, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]},
      "transform": {"matrix": [0, 0, 1, 5, 0, 1, 0, 6, -1, 0, 0, 7, 0, 0, 0, 1]}})");
  EXPECT_EQ(matrix.positions[0], Vec3(5, 6, 6));
}

TEST(NativeObjects, MirroringKeepsFrontsOutside) {
  const Surface box = only_surface(
      R"({"material": "white", "cylinder": {"base": [0,0,0], "top": [1,2,3], "radius": 1, "segments": 24},
      "transform": [{"scale": [-1, 2, 0.5]}, {"rotate": {"axis": [1, 1, 0], "angle_deg": 33}}]})");
  EXPECT_GT(volume(box), 0);
  expect_normals_outside(box);
}

TEST(NativeObjects, ArraysMultiply) {
  const Scene scene = read_text(room_of(R"({"name": "lamp", "material": "lamp",
      "quad": {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]}, "transform": {"rotate": {"axis": [0, 0, 1], "angle_deg": 90}},
      "array": [{"count": 3, "step": [2, 0, 0]}, {"count": 2, "step": [0, 0, 5]}]})"));
  ASSERT_EQ(scene.surfaces.size(), 6u);
  EXPECT_EQ(scene.surfaces[5].name, "lamp[2,1]");
  EXPECT_EQ(scene.surfaces[5].positions[0], Vec3(4, 0, 5));
  const Scene ring =
      read_text(room_of(R"({"material": "lamp", "quad": {"corner": [1, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]},
      "array": {"count": 4, "rotate": {"axis": [0, 1, 0], "angle_deg": 90}}})"));
  EXPECT_EQ(ring.surfaces.at(2).positions[0], Vec3(-1, 0, 0));
}

TEST(NativeObjects, GroupsNestAndInheritMaterials) {
  const Scene scene = read_text(room(R"("materials": {"a": {"reflectance": 0.1}, "b": {"reflectance": 0.2}},
      "groups": {"leg": [{"name": "leg", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}}],
                 "table": [{"name": "legs", "group": "leg", "array": {"count": 2, "step": [3, 0, 0]}},
                           {"name": "top", "material": "b", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}}]},
      "objects": [{"name": "table", "group": "table", "material": "a", "transform": {"translate": [0, 0, 1]}},
                  {"name": "table", "objects": [{"name": "top", "material": "a", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}}]}])"));
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(scene.surfaces[1].name, "table/legs[1]/leg");
  EXPECT_EQ(scene.surfaces[1].positions[0], Vec3(3, 0, 1));
  EXPECT_EQ(scene.material_of(scene.surfaces[1]).name, "a");
  EXPECT_EQ(scene.material_of(scene.surfaces[2]).name, "b");
  EXPECT_EQ(scene.surfaces[3].name, "table/top #2");
}

TEST(NativeObjects, RefusesWhatCannotBe) {
  const std::string groups =
      R"("materials": {"w": {}}, "groups": {"a": [{"group": "b"}], "b": [{"group": "a"}]}, )";
  expect_refused(room(groups + R"("objects": [{"group": "a"}])"), {"#/groups/b/0/group", "contains itself"});
  expect_refused(room(groups + R"("objects": [{"group": "c"}])"), {"#/objects/0/group", "no group \"c\""});
  expect_refused(room_of(R"({"material": "wihte", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}})"),
                 {"#/objects/0/material", "Did you mean \"white\"?"});
  expect_refused(room_of(R"({"quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}})"),
                 {"#/objects/0", "no material"});
  expect_refused(room_of(R"({"material": "white", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [2,0,0]}})"),
                 {"parallel"});
  expect_refused(room_of(R"({"material": "white"})"), {"no content"});
  expect_refused(room_of(R"({"material": "white", "objects": [], "group": "x"})"), {"cannot be both"});
  expect_refused(room_of(R"({"material": "white", "box": {"min": [0,0,0], "max": [1,0,1]}})"),
                 {"/box/max", "exceed"});
  expect_refused(room_of(R"({"material": "white", "objects": [], "transform": {"scale": 0}})"), {"flattens"});
  expect_refused(room_of(R"({"material": "white", "objects": [], "transform": {"translate": [1, 2]}})"),
                 {"/transform/translate", "2 values, expected 3"});
  expect_refused(
      room_of(R"({"material": "white", "disk": {"center": [0,0,0], "normal": [0,0,1], "radius": -1}})"),
      {"/disk/radius", "greater than 0"});
}

TEST(NativeObjects, RefusesExplosions) {
  expect_refused(
      room_of(
          R"({"objects": [], "array": [{"count": 100000, "step": [1,0,0]}, {"count": 100000, "step": [1,0,0]}]})"),
      {"more than 100000 placements"});
  expect_refused(
      room_of(R"({"material": "white", "sphere": {"center": [0,0,0], "radius": 1, "segments": 1000000000}})"),
      {"3 to 1024"});
  // Each group holds the next one ten times: 10^9 objects in ten lines.
  std::string groups = R"("g9": [])";
  for (int i = 0; i < 9; ++i) {
    groups += R"(, "g)" + std::to_string(i) + R"(": [{"group": "g)" + std::to_string(i + 1) +
              R"(", "array": {"count": 10, "step": [1, 0, 0]}}])";
  }
  expect_refused(room(R"("materials": {}, "groups": {)" + groups + R"(}, "objects": [{"group": "g0"}])"),
                 {"more than 1000000 objects"});
}

}  // namespace
}  // namespace reemit
