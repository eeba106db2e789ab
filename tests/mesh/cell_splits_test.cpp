// Cells that are cut further: each point belongs to the part it lies in.

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/zones/zone_cells.h"
#include "mesh/zones/zone_mesh.h"
#include "tests/support/random_splits.h"

namespace reemit {
namespace {

/// A two-sided triangle and a one-sided one.
BaseMesh two_triangles(std::uint32_t n, std::uint32_t m) {
  BaseMesh base;
  base.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0.1}};
  base.triangles.resize(2);
  base.triangles[0].vertex = {0, 1, 2};
  base.triangles[0].divisions = n;
  base.triangles[0].two_sided = true;
  base.triangles[1].vertex = {1, 0, 3};
  base.triangles[1].divisions = m;
  for (BaseTriangle& t : base.triangles) t.surface = SurfaceId(0);
  return base;
}

ZoneMesh split_mesh(std::uint32_t n, std::uint32_t m, unsigned seed) {
  const BaseMesh base = two_triangles(n, m);
  return ZoneMesh(base, {}, test::random_splits(base, 8, seed));
}

double area_of(const CellCorners& cell) {
  const auto p = cell.corners();
  return 0.5 * ((p[1].u - p[0].u) * (p[2].v - p[0].v) - (p[2].u - p[0].u) * (p[1].v - p[0].v));
}

bool same_place(const Barycentric& a, const Barycentric& b) {
  return std::abs(a.u - b.u) < 1e-15 && std::abs(a.v - b.v) < 1e-15;
}

TEST(CellSplits, HalvesMeetInTheLineFromACornerToTheMiddleOfTheEdgeOppositeIt) {
  for (const std::uint32_t n : {1U, 2U, 3U, 8U})
    for (std::uint32_t c = 0; c < n * n; ++c)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const CellCorners whole = grid_cell(n, c);
        const auto [first, second] = halves_of(whole, corner);
        const Barycentric from = whole.corner(corner);
        const Barycentric next = whole.corner((corner + 1) % 3);
        const Barycentric last = whole.corner((corner + 2) % 3);
        const Barycentric middle{(next.u + last.u) / 2, (next.v + last.v) / 2};
        EXPECT_TRUE(same_place(first.corner(0), from) && same_place(first.corner(1), next) &&
                    same_place(first.corner(2), middle));
        EXPECT_TRUE(same_place(second.corner(0), from) && same_place(second.corner(1), middle) &&
                    same_place(second.corner(2), last));
        for (const CellCorners& half : {first, second}) {
          EXPECT_NEAR(area_of(half), area_of(whole) / 2, 1e-15);
          EXPECT_DOUBLE_EQ(half.share(), 2 * area_of(half));
        }
      }
}

TEST(CellSplits, APointKeepsItsPlaceInTheHalfItLiesIn) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto place = [](const CellCorners& cell, const InCell& x) {
    const SidePoint p = cell_point({TriangleId(0), true, cell}, x.a, x.b);
    return p.at;
  };
  for (std::uint32_t corner = 0; corner < 3; ++corner)
    for (int i = 0; i < 1000; ++i) {
      const CellCorners whole = grid_cell(3, static_cast<std::uint32_t>(i) % 9);
      InCell x{uniform(random), uniform(random)};
      if (x.a + x.b > 1) x = {1 - x.a, 1 - x.b};
      const Barycentric before = place(whole, x);
      const CellHalves halves = halves_of(whole, corner);
      const std::uint32_t half = half_of(x, corner);
      ASSERT_GE(x.a, -1e-6F);
      ASSERT_GE(x.b, -1e-6F);
      ASSERT_LE(x.a + x.b, 1 + 1e-6F);
      const Barycentric after = place(half == 0 ? halves.first : halves.second, x);
      ASSERT_NEAR(after.u, before.u, 1e-6);
      ASSERT_NEAR(after.v, before.v, 1e-6);
    }
}

TEST(CellSplits, CellsAreHalvedAsLongAsTheirGridIsNotTooFine) {
  CellCorners cell;
  int cuts = 0;
  for (; can_halve(cell, 0) && cuts < 100; ++cuts) cell = halves_of(cell, 0).first;
  // Always from the same corner: every cut halves an edge.
  EXPECT_EQ(cuts, 15);
  EXPECT_EQ(cell.divisions, kMostDivisions);
  EXPECT_DOUBLE_EQ(cell.share(), std::ldexp(1.0, -cuts));
}

TEST(CellSplits, EveryPointBelongsToThePartItLiesIn) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const ZoneMesh mesh = split_mesh(1 + seed, 8, seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<int> points(mesh.zone_count(), 0);
    constexpr int kPoints = 20'000;
    for (std::size_t side = 0; side < mesh.side_count(); ++side) {
      if (!mesh.has_zones(SideId(side))) continue;
      for (int i = 0; i < kPoints; ++i) {
        float u = uniform(random);
        float v = uniform(random);
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        const TriangleId t = triangle_of(SideId(side));
        const ZoneId z = mesh.zone_at(t, u, v, is_front(SideId(side)));
        ASSERT_TRUE(z.valid());
        ASSERT_EQ(mesh.zone_side(z), SideId(side));
        ++points[z.index()];
        // Within rounding of its corners: all three barycentric coordinates in the cell are positive.
        const auto c = mesh.zone_barycentrics(z);
        const auto turn = [](const Barycentric& a, const Barycentric& b, double x, double y) {
          return (b.u - a.u) * (y - a.v) - (b.v - a.v) * (x - a.u);
        };
        for (std::size_t k = 0; k < 3; ++k)
          ASSERT_GT(turn(c[k], c[(k + 1) % 3], static_cast<double>(u), static_cast<double>(v)), -1e-7);
      }
    }
    // Points fall into parts in proportion to areas: within 6 standard deviations in each of some 3,000.
    for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
      const double share = mesh.zone_area(ZoneId(z)) / mesh.triangle_area(mesh.zone_triangle(ZoneId(z)));
      const double expected = kPoints * share;
      EXPECT_NEAR(points[z], expected, 6 * std::sqrt(expected) + 6) << "zone " << z;
    }
  }
}

TEST(CellSplits, ZonesOf16PointsAreThoseOfEach) {
  // Cut cells beside whole ones, sides without zones, lanes without a triangle, points on edges and corners.
  for (const bool is_split : {false, true}) {
    const ZoneMesh mesh = is_split ? split_mesh(3, 4, 5) : ZoneMesh(two_triangles(3, 1));
    std::mt19937 random(23);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int block = 0; block < 2000; ++block) {
      std::uint32_t triangle[16];
      float u[16];
      float v[16];
      bool front[16];
      for (int lane = 0; lane < 16; ++lane) {
        triangle[lane] = random() % 8 == 0 ? ZoneMesh::kNone : static_cast<std::uint32_t>(random() % 2);
        front[lane] = random() % 2 == 0;
        const auto on_grid = [&](float x) { return random() % 4 == 0 ? std::round(12 * x) / 12 : x; };
        u[lane] = on_grid(uniform(random));
        v[lane] = (1 - u[lane]) * on_grid(uniform(random));
      }
      std::uint32_t zone[16];
      mesh.zones_at16({triangle, u, v, front}, zone);
      for (int lane = 0; lane < 16; ++lane) {
        const ZoneId expected = triangle[lane] == ZoneMesh::kNone
                                    ? ZoneId()
                                    : mesh.zone_at(TriangleId(triangle[lane]), u[lane], v[lane], front[lane]);
        ASSERT_EQ(ZoneId(zone[lane]), expected) << "at " << u[lane] << ", " << v[lane];
      }
    }
  }
  std::uint32_t zone[16];
  const std::vector<std::uint32_t> none(16, ZoneMesh::kNone);
  const float zeros[16] = {};
  const bool front[16] = {};
  ZoneMesh(BaseMesh()).zones_at16({none.data(), zeros, zeros, front}, zone);
  for (const std::uint32_t z : zone) EXPECT_EQ(z, ZoneMesh::kNone);
}

TEST(CellSplits, ZonesCoverEverySideOnce) {
  const ZoneMesh mesh = split_mesh(3, 4, 11);
  const ZoneCells cells(mesh);
  ASSERT_EQ(cells.size(), mesh.zone_count());
  std::vector<double> area(mesh.side_count(), 0.0);
  std::size_t finer = 0;
  for (std::size_t i = 0; i < mesh.zone_count(); ++i) {
    const ZoneId z(i);
    EXPECT_EQ(cells.zone(i), z);
    EXPECT_DOUBLE_EQ(cells.area(i), mesh.zone_area(z));
    const SideCell cell = cells.cell(i);
    EXPECT_EQ(side_of(cell.triangle, cell.front), mesh.zone_side(z));
    area[mesh.zone_side(z).index()] += mesh.zone_area(z);
    if (cell.corners.divisions > mesh.triangle(cell.triangle).divisions) ++finer;
    const SidePoint middle = cell_point(cell, 1.0F / 3, 1.0F / 3);
    const auto u = static_cast<float>(middle.at.u);
    const auto v = static_cast<float>(middle.at.v);
    EXPECT_EQ(mesh.zone_at(cell.triangle, u, v, cell.front), z);
    EXPECT_LT((mesh.zone_centroid(z) - mesh.point(cell.triangle, middle.at.u, middle.at.v)).norm(), 1e-6);
  }
  EXPECT_GT(finer, mesh.zone_count() / 4);
  for (std::size_t s = 0; s < mesh.side_count(); ++s) {
    const SideId side(s);
    EXPECT_NEAR(area[s], mesh.has_zones(side) ? mesh.triangle_area(triangle_of(side)) : 0, 1e-12);
  }
}

TEST(CellSplits, WhatCannotBeIsRefused) {
  const BaseMesh base = two_triangles(1, 1);
  const SideId front = side_of(TriangleId(0), true);
  const SideId no_zones = side_of(TriangleId(1), false);
  const auto mesh_of = [&](CellSplits splits, ZoneGroups groups = {}) {
    return ZoneMesh(base, std::move(groups), std::move(splits));
  };
  EXPECT_EQ(mesh_of({{front}, {1, 3, 0, 0, 0}}).zone_count(), 5U);
  EXPECT_THROW(mesh_of({{front}, {1, 3, 0, 0}}), std::invalid_argument);  // ends too early
  EXPECT_THROW(ZoneMesh(two_triangles(65535, 1), {}, {{front}, {1, 3, 0, 0, 0}}),
               std::invalid_argument);  // without memory for 65535^2 cells
  EXPECT_THROW(mesh_of({{front}, {1, 3, 0, 0, 0, 0}}), std::invalid_argument);    // more than cells
  EXPECT_THROW(mesh_of({{no_zones}, {1, 3, 0, 0, 0}}), std::invalid_argument);    // no zones there
  EXPECT_THROW(mesh_of({{SideId(99)}, {1, 3, 0, 0, 0}}), std::invalid_argument);  // no such side
  EXPECT_THROW(mesh_of({{front}, {4, 0, 0}}), std::invalid_argument);             // no such corner
  EXPECT_THROW(mesh_of({{front}, std::vector<std::uint8_t>(80, 1)}), std::invalid_argument);  // no end
  ZoneGroups group;
  group.of_side = {0, ZoneGroups::kOwn, ZoneGroups::kOwn, ZoneGroups::kOwn};
  group.count = 1;
  EXPECT_THROW(mesh_of({{front}, {1, 3, 0, 0, 0}}, group), std::invalid_argument);  // in a group
}

}  // namespace
}  // namespace reemit
