#include "mesh/zones/hairlines.h"

#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

/// A unit square of two triangles, and further triangles, whose new corners have numbers from 4.
BaseMesh square_and(const std::vector<Vec3>& more,
                    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  BaseMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.vertices.insert(mesh.vertices.end(), more.begin(), more.end());
  for (const auto& vertex : {std::array<std::uint32_t, 3>{0, 1, 2}, std::array<std::uint32_t, 3>{0, 2, 3}})
    mesh.triangles.emplace_back().vertex = vertex;
  for (const auto& vertex : triangles) mesh.triangles.emplace_back().vertex = vertex;
  return mesh;
}

TEST(Hairlines, ThereAreNoneInASheet) {
  EXPECT_FALSE(may_have_hairlines(square_and({}, {})));
}

TEST(Hairlines, ThereAreNoneWhereTrianglesShareAnEdge) {
  EXPECT_FALSE(may_have_hairlines(square_and({{2, 0.5, 0}}, {{1, 4, 2}})));
  EXPECT_FALSE(may_have_hairlines(square_and({{1, 0.5, 1}}, {{1, 4, 2}})));  // upright
}

TEST(Hairlines, OneIsWhereAVertexLiesOnTheEdgeOfAnother) {
  EXPECT_TRUE(may_have_hairlines(square_and({{1, 0.5, 0}, {2, 0.5, 0}}, {{1, 5, 4}, {4, 5, 2}})));
}

TEST(Hairlines, ThereAreNoneWhereBothEndsOfAnEdgeAreTheSameNumbers) {
  EXPECT_FALSE(may_have_hairlines(square_and({{1, 0, 0}, {1, 1, 0}, {2, 0.5, 0}}, {{4, 6, 5}})));
}

TEST(Hairlines, OneIsWhereTheEndsOfEdgesNearlyMatch) {
  EXPECT_TRUE(may_have_hairlines(square_and({{1 + 1e-6, 0, 0}, {1 + 1e-6, 1, 0}, {2, 0.5, 0}}, {{4, 6, 5}})));
  EXPECT_FALSE(may_have_hairlines(square_and({{1.01, 0, 0}, {1.01, 1, 0}, {2, 0.5, 0}}, {{4, 6, 5}})));
}

TEST(Hairlines, OneIsWhereAnEdgeStandsOnAFaceThatIsNotCutThere) {
  EXPECT_TRUE(may_have_hairlines(square_and({{0.2, 0.1, 0}, {0.6, 0.1, 0}, {0.4, 0.1, 1}}, {{4, 5, 6}})));
  EXPECT_TRUE(may_have_hairlines(square_and({{0.2, 0.1, -1}, {0.6, 0.1, -1}, {0.4, 0.1, 1}}, {{4, 5, 6}})));
}

TEST(Hairlines, RoundShapesMayHaveThemWhereTheyTouchFaces) {
  BaseMesh mesh = square_and({}, {});
  mesh.shapes.emplace_back();
  EXPECT_TRUE(may_have_hairlines(mesh));
}

}  // namespace
}  // namespace reemit
