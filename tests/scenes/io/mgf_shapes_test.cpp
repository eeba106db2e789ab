#include "scenes/io/mgf_shapes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
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

void expect_planar(const std::vector<Polygon>& faces) {
  for (const Polygon& face : faces) {
    const Vec3 normal = loop_area(face.outer).normalized();
    for (const Vec3& p : face.outer) EXPECT_NEAR((p - face.outer[0]).dot(normal), 0, 1e-12);
  }
}

TEST(MgfShapes, SphereIsClosedAndItsAreaIsThatOfItsTessellation) {
  const Vec3 centre(1, 2, 3);
  for (const int n : {16, 24, 32}) {
    const auto faces = mgf_sphere(centre, 0.5, {n, false}, "here");
    EXPECT_EQ(faces.size(), static_cast<std::size_t>(n * n / 2));
    const double exact = 4 * pi * 0.25;
    const double area = total_area(faces);
    EXPECT_LT(area, exact);
    // Chords shorten meridians and parallels: relative error (pi/n)^2/6 for each, and the inscribed heights
    // again.
    EXPECT_NEAR(area / exact, 1, 1.0 * pi * pi / (n * n)) << n;
    EXPECT_GT(1 - area / exact, 0.5 * pi * pi / (n * n)) << n;
    EXPECT_NEAR(enclosed_volume(faces) / (4 * pi / 3 * 0.125), 1, 2 * pi * pi / (n * n)) << n;
    expect_consistent_normals(faces);
    expect_planar(faces);
    for (const Polygon& face : faces)
      for (const Vec3& p : face.outer) EXPECT_NEAR((p - centre).norm(), 0.5, 1e-12);
  }
}

TEST(MgfShapes, NegativeRadiiLookInwards) {
  EXPECT_LT(enclosed_volume(mgf_sphere({0, 0, 0}, -1, {}, "here")), -4);
  EXPECT_LT(enclosed_volume(mgf_torus(vertex({0, 0, 0}, {0, 0, 1}), -1, -2, {}, "here")), -1);
  expect_consistent_normals(mgf_sphere({0, 0, 0}, -1, {}, "here"));
  expect_consistent_normals(mgf_cone({0, 0, 0}, -1, {0, 0, 1}, -0.5, "here"));
  for (const Polygon& face : mgf_cone({0, 0, 0}, -1, {0, 0, 1}, -1, "here"))
    EXPECT_LT(loop_area(face.outer).dot(face.outer[0] - Vec3(0, 0, face.outer[0].z())), 0);
}

TEST(MgfShapes, LuminairesKeepTheirArea) {
  EXPECT_NEAR(total_area(mgf_sphere({0, 1, 0}, 0.3, mgf_roundness(0.3, true), "here")), 4 * pi * 0.09, 1e-12);
  const MgfVertex centre = vertex({0, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(total_area(mgf_torus(centre, 0.2, 0.4, mgf_roundness(0.4, true), "here")),
              4 * pi * pi * 0.3 * 0.1, 1e-12);
  EXPECT_EQ(mgf_roundness(0.001, false).segments, 16);
  EXPECT_EQ(mgf_roundness(100, false).segments, 32);
  EXPECT_EQ(mgf_roundness(0.1, false).segments, 24);
}

TEST(MgfShapes, CylinderAndConeAreas) {
  const int n = kMgfOpenSegments;
  const double circumference = 2 * n * std::sin(pi / n);  // of the polygon inside the unit circle
  const auto cylinder = mgf_cone({1, 1, 1}, 0.5, {1, 4, 1}, 0.5, "here");
  EXPECT_NEAR(total_area(cylinder), 0.5 * circumference * 3, 1e-12);
  expect_consistent_normals(cylinder);
  const auto cone = mgf_cone({0, 0, 0}, 0, {0, 0, 2}, 1, "here");
  EXPECT_EQ(cone.size(), static_cast<std::size_t>(n));
  for (const Polygon& face : cone) EXPECT_EQ(face.outer.size(), 3U) << "the apex is one corner";
  EXPECT_NEAR(total_area(cone), n * std::sin(pi / n) * std::sqrt(4 + std::pow(std::cos(pi / n), 2)), 1e-12);
  expect_consistent_normals(cone);
  expect_planar(mgf_cone({0, 0, 0}, 0.3, {1, 2, 3}, 0.7, "here"));
}

TEST(MgfShapes, CapsShareTheCornersOfTheirShell) {
  using Key = std::array<double, 3>;
  const Vec3 end(0.3, -0.4, 1.2);
  const auto rounded = [](const Vec3& p) {
    return Key{std::round(p.x() * 1e9), std::round(p.y() * 1e9), std::round(p.z() * 1e9)};
  };
  std::set<Key> shell;
  for (const Polygon& face : mgf_cone({0, 0, 0}, 0.2, end, 0.2, "here"))
    for (const Vec3& p : face.outer) shell.insert(rounded(p));
  for (const Vec3& normal : {Vec3(end.normalized()), Vec3(-end.normalized())}) {
    const auto cap = mgf_ring(vertex(end, normal), 0, 0.2, "here");
    for (const Vec3& p : cap[0].outer) EXPECT_TRUE(shell.contains(rounded(p)));
  }
}

TEST(MgfShapes, RingIsOneFaceWithAHole) {
  const int n = kMgfOpenSegments;
  const auto ring = mgf_ring(vertex({0, 0, 5}, {0, 0, -1}), 0.5, 1, "here");
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_EQ(ring[0].holes.size(), 1U);
  const Vec3 area = test::area_vector(ring[0]);
  EXPECT_NEAR(area.z(), -0.75 * n / 2 * std::sin(2 * pi / n), 1e-12);
  EXPECT_TRUE(mgf_ring(vertex({0, 0, 5}, {0, 0, -1}), 0, 1, "here")[0].holes.empty());
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
  EXPECT_THROW(mgf_sphere({0, 0, 0}, 0, {}, "here"), InputError);
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
