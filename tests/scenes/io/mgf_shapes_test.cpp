#include "scenes/io/mgf/mgf_shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "scenes/model/measures.h"
#include "tests/scenes/io/face_area.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::enclosed_volume;
using test::total_area;

MgfVertex vertex(const Vec3& position, const Vec3& normal = {0, 0, 0}) {
  return {position, normal};
}

// Corners on the given side of the surface: the shading normals look the same way as the face.
void expect_consistent_normals(const std::vector<Polygon>& faces) {
  for (const Polygon& face : faces) {
    ASSERT_EQ(face.normals.size(), face.outer.size());
    const Vec3 front = loop_area(face.outer).normalized();
    for (const Vec3& normal : face.normals) {
      EXPECT_NEAR(normal.norm(), 1, 1e-12);
      EXPECT_GT(normal.dot(front), 0.9);
    }
  }
}

TEST(MgfShapes, RoundShapesStayRound) {
  const auto sphere = std::get<Sphere>(mgf_sphere({1, 2, 3}, 0.5, "here"));
  EXPECT_EQ(sphere.centre, Vec3(1, 2, 3));
  EXPECT_EQ(sphere.radius, 0.5);
  EXPECT_FALSE(sphere.inward);
  const auto cylinder = std::get<Cylinder>(mgf_cone({1, 1, 1}, 0.5, {1, 4, 1}, 0.5, "here"));
  EXPECT_NEAR(shape_area(cylinder), 2 * pi * 0.5 * 3, 1e-12);
  EXPECT_NEAR(shape_area(mgf_cone({0, 0, 0}, 0, {0, 0, 2}, 1, "here")), pi * std::sqrt(5.0), 1e-12);
  const auto ring = std::get<Disk>(mgf_ring(vertex({0, 0, 5}, {0, 0, -1}), 0.5, 1, "here"));
  EXPECT_EQ(ring.normal, Vec3(0, 0, -1));
  EXPECT_NEAR(shape_area(ring), pi * 0.75, 1e-12);
}

TEST(MgfShapes, NegativeRadiiLookInwards) {
  EXPECT_LT(enclosed_volume(mgf_torus(vertex({0, 0, 0}, {0, 0, 1}), -1, -2, {}, "here")), -1);
  EXPECT_TRUE(std::get<Sphere>(mgf_sphere({0, 0, 0}, -1, "here")).inward);
  EXPECT_TRUE(std::get<Cone>(mgf_cone({0, 0, 0}, -1, {0, 0, 1}, -0.5, "here")).inward);
  EXPECT_TRUE(std::get<Cylinder>(mgf_cone({0, 0, 0}, -1, {0, 0, 1}, -1, "here")).inward);
}

TEST(MgfShapes, LuminairesKeepTheirArea) {
  const MgfVertex centre = vertex({0, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(total_area(mgf_torus(centre, 0.2, 0.4, mgf_roundness(0.4, true), "here")),
              4 * pi * pi * 0.3 * 0.1, 1e-12);
  EXPECT_EQ(mgf_roundness(0.001, false).segments, 16);
  EXPECT_EQ(mgf_roundness(100, false).segments, 32);
  EXPECT_EQ(mgf_roundness(0.1, false).segments, 24);
}

TEST(MgfShapes, TorusAreaAndOrientation) {
  const auto torus = mgf_torus(vertex({0, 0, 0}, {0, 0, 1}), 1, 2, {32, false}, "here");
  EXPECT_NEAR(total_area(torus) / (4 * pi * pi * 1.5 * 0.5), 1, 0.012);
  EXPECT_NEAR(enclosed_volume(torus) / (2 * pi * pi * 1.5 * 0.25), 1, 0.05);
  expect_consistent_normals(torus);
  for (const Polygon& face : mgf_torus(vertex({0, 0, 0}, {0, 0, 1}), 0, 2, {16, false}, "here"))
    EXPECT_LE(face.outer.size(), 4U);
}

TEST(MgfShapes, PrismIsAClosedBoxOutwardsOrInwards) {
  // Unit cube of the description: the first face looks along -z.
  const std::vector<MgfVertex> base = {vertex({0, 0, 0}), vertex({0, 1, 0}), vertex({1, 1, 0}),
                                       vertex({1, 0, 0})};
  const auto cube = mgf_prism(base, 1, "here");
  EXPECT_EQ(cube.size(), 6U);
  EXPECT_NEAR(total_area(cube), 6, 1e-12);
  EXPECT_NEAR(enclosed_volume(cube), 1, 1e-12);
  const auto inverted = mgf_prism(base, -1, "here");
  EXPECT_NEAR(enclosed_volume(inverted), -1, 1e-12);
  for (const Polygon& face : inverted)
    for (const Vec3& p : face.outer) EXPECT_LE(p.z(), 1e-12) << "extruded along the front of the first face";
}

TEST(MgfShapes, PrismNormalsSmoothItsSidesOnly) {
  std::vector<MgfVertex> base;
  for (int k = 0; k < 6; ++k) {
    const Vec3 radial(std::cos(k * pi / 3), std::sin(k * pi / 3), 0);
    base.push_back(vertex(radial, radial));
  }
  int smooth = 0;
  for (const Polygon& face : mgf_prism(base, 2, "here")) {
    if (face.normals.empty()) continue;
    ++smooth;
    EXPECT_EQ(face.outer.size(), 4U);
    EXPECT_NEAR(face.normals[0].dot(loop_area(face.outer).normalized()), std::cos(pi / 6), 1e-12);
  }
  EXPECT_EQ(smooth, 6);
}

TEST(MgfShapes, PrismOfAnOutlineWithSeamHasAShaft) {
  std::vector<MgfVertex> outline;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{
           {0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}, {0, 4}})
    outline.push_back(vertex({x, y, 0}));
  const auto prism = mgf_prism(outline, 2, "here");
  EXPECT_EQ(prism.size(), 10U);
  EXPECT_NEAR(total_area(prism), 2 * 12 + 2 * 16 + 2 * 8, 1e-12);
  EXPECT_NEAR(enclosed_volume(prism), 24, 1e-12);
}

TEST(MgfShapes, FacesTakeNormalsWhereTheyHaveThem) {
  const std::vector<MgfVertex> corners = {vertex({0, 0, 0}, {0, 0.6, 0.8}), vertex({1, 0, 0}),
                                          vertex({0, 1, 0})};
  const auto faces = mgf_face({corners}, "here");
  ASSERT_EQ(faces.size(), 1U);
  ASSERT_EQ(faces[0].normals.size(), 3U);
  EXPECT_EQ(faces[0].normals[0], Vec3(0, 0.6, 0.8));
  EXPECT_EQ(faces[0].normals[1], Vec3(0, 0, 1));
}

TEST(MgfShapes, RefuseIllegalArguments) {
  const MgfVertex up = vertex({0, 0, 0}, {0, 0, 1});
  EXPECT_THROW(mgf_sphere({0, 0, 0}, 0, "here"), InputError);
  EXPECT_THROW(mgf_cone({0, 0, 0}, 1, {0, 0, 1}, -1, "here"), InputError);
  EXPECT_THROW(mgf_cone({0, 0, 0}, 0, {0, 0, 1}, 0, "here"), InputError);
  EXPECT_THROW(mgf_cone({0, 0, 0}, 1, {0, 0, 0}, 1, "here"), InputError);
  EXPECT_THROW(mgf_ring(vertex({0, 0, 0}), 0, 1, "here"), InputError);
  EXPECT_THROW(mgf_ring(up, 1, 1, "here"), InputError);
  EXPECT_THROW(mgf_ring(up, -1, 1, "here"), InputError);
  EXPECT_THROW(mgf_torus(up, 2, 1, {}, "here"), InputError);
  EXPECT_THROW(mgf_torus(up, -1, 2, {}, "here"), InputError);
  EXPECT_THROW(mgf_prism(std::vector<MgfVertex>(3, up), 1, "here"), InputError);
  EXPECT_THROW(mgf_prism(std::vector<MgfVertex>(2, up), 1, "here"), InputError);
  EXPECT_THROW(mgf_face({{up, up}}, "here"), InputError);
}

}  // namespace
}  // namespace reemit
