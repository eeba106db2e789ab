#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/zones/cell_corners.h"
#include "mesh/zones/zone_sizing.h"

namespace reemit {
namespace {

constexpr std::uint32_t kDivisions[] = {1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 33, 96, 128, 1000};

TEST(ZoneLookup, CentroidOfEveryZoneIsInThatZone) {
  for (const std::uint32_t n : kDivisions) {
    for (std::uint32_t z = 0; z < n * n; ++z) {
      const auto c = grid_cell(n, z).corners();
      const auto u = static_cast<float>((c[0].u + c[1].u + c[2].u) / 3);
      const auto v = static_cast<float>((c[0].v + c[1].v + c[2].v) / 3);
      ASSERT_EQ(zone_in_triangle(n, u, v), z) << "n = " << n;
    }
  }
}

TEST(ZoneLookup, ZonesAreCongruentAndCounterClockwise) {
  for (const std::uint32_t n : kDivisions) {
    for (std::uint32_t z = 0; z < n * n; ++z) {
      const auto c = grid_cell(n, z).corners();
      const double twice = (c[1].u - c[0].u) * (c[2].v - c[0].v) - (c[2].u - c[0].u) * (c[1].v - c[0].v);
      ASSERT_NEAR(twice * n * n, 1.0, 1e-9) << "n = " << n << ", zone " << z;
    }
  }
}

TEST(ZoneLookup, RandomPointLiesInItsZone) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const std::uint32_t n : kDivisions) {
    for (int i = 0; i < 2000; ++i) {
      float u = uniform(rng);
      float v = uniform(rng);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const std::uint32_t z = zone_in_triangle(n, u, v);
      ASSERT_LT(z, n * n);
      const auto c = grid_cell(n, z).corners();
      const double d = (c[1].u - c[0].u) * (c[2].v - c[0].v) - (c[2].u - c[0].u) * (c[1].v - c[0].v);
      const double b1 = ((u - c[0].u) * (c[2].v - c[0].v) - (c[2].u - c[0].u) * (v - c[0].v)) / d;
      const double b2 = ((c[1].u - c[0].u) * (v - c[0].v) - (u - c[0].u) * (c[1].v - c[0].v)) / d;
      const double rounding = 4e-7 * n;  // of u and v in single precision
      ASSERT_GE(b1, -rounding) << "n = " << n;
      ASSERT_GE(b2, -rounding) << "n = " << n;
      ASSERT_LE(b1 + b2, 1 + rounding) << "n = " << n;
    }
  }
}

TEST(ZoneLookup, PointsOutsideTheTriangleAreClampedIntoIt) {
  for (const std::uint32_t n : kDivisions)
    for (const auto& [u, v] : std::vector<std::pair<float, float>>{{0, 0},
                                                                   {1, 0},
                                                                   {0, 1},
                                                                   {1.0001F, 0},
                                                                   {-0.0001F, 0.5F},
                                                                   {0.5F, 0.5001F},
                                                                   {1, 1},
                                                                   {-1, -1},
                                                                   {9, -9}})
      EXPECT_LT(zone_in_triangle(n, u, v), n * n) << n << " " << u << " " << v;
}

TEST(ZoneMesh, PointsOfAZoneAreInThatZoneAndOneSidedBacksHaveNone) {
  BaseMesh base;
  base.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}};
  for (const bool two_sided : {false, true}) {
    BaseTriangle triangle;
    triangle.vertex = {0, 1, 2};
    triangle.divisions = two_sided ? 5 : 3;
    triangle.two_sided = two_sided;
    base.triangles.push_back(triangle);
  }
  const ZoneMesh mesh(base);
  ASSERT_EQ(mesh.zone_count(), 9U + 2 * 25U);
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    for (const auto& [a, b] : {std::pair(0.1F, 0.1F), std::pair(0.8F, 0.1F), std::pair(0.1F, 0.8F)}) {
      float u = 0.5F;
      const SidePoint x = cell_point(mesh.pick_cell(ZoneId(z), u), a, b);
      EXPECT_EQ(mesh.zone_at(x.triangle, static_cast<float>(x.at.u), static_cast<float>(x.at.v), x.front),
                ZoneId(z));
    }
  EXPECT_TRUE(mesh.has_zones(TriangleId(0), true));
  EXPECT_FALSE(mesh.has_zones(TriangleId(0), false));
  EXPECT_FALSE(mesh.zone_at(TriangleId(0), 0.3F, 0.3F, false).valid());
  EXPECT_TRUE(mesh.zone_at(TriangleId(1), 0.3F, 0.3F, false).valid());
}

TEST(ZoneSizing, DivisionsAreTheSmallestOfTheirSeries) {
  EXPECT_EQ(divisions_at_least(0), 1U);
  EXPECT_EQ(divisions_at_least(1), 1U);
  EXPECT_EQ(divisions_at_least(1.01), 2U);
  EXPECT_EQ(divisions_at_least(2.5), 3U);
  EXPECT_EQ(divisions_at_least(3.5), 4U);
  EXPECT_EQ(divisions_at_least(5), 6U);
  EXPECT_EQ(divisions_at_least(6.1), 8U);
  EXPECT_EQ(divisions_at_least(9), 12U);
  EXPECT_EQ(divisions_at_least(12.5), 16U);
  EXPECT_EQ(divisions_at_least(25), 32U);
}

}  // namespace
}  // namespace reemit
