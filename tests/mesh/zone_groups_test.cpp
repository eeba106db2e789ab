#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/zones/zone_cells.h"
#include "mesh/zones/zone_mesh.h"

namespace reemit {
namespace {

/// Four triangles with legs of 1, 2, 3 and 4 m, all of surface 0, one above the other, the first three
/// two-sided.
BaseMesh four_triangles() {
  BaseMesh base;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const double leg = 1 + i;
    base.vertices.insert(base.vertices.end(), {{0, 0, leg}, {leg, 0, leg}, {0, leg, leg}});
    BaseTriangle t;
    t.vertex = {3 * i, 3 * i + 1, 3 * i + 2};
    t.surface = SurfaceId(0);
    t.two_sided = i < 3;
    base.triangles.push_back(t);
  }
  base.triangles[1].divisions = 2;
  return base;
}

constexpr std::uint32_t kOwn = ZoneGroups::kOwn;

/// Fronts of the first and the third triangle in one group, backs of all that have one in a sealed one.
ZoneGroups two_groups() {
  return {.of_side = {1, 0, kOwn, 0, 1, 0, kOwn, kOwn}, .count = 2, .sealed = 1};
}

TEST(ZoneGroups, MembersShareAZoneAndTheOthersKeepTheirs) {
  const ZoneMesh mesh(four_triangles(), two_groups());
  // Four cells of the second front, the fourth front, and the groups.
  ASSERT_EQ(mesh.zone_count(), 4U + 1U + 2U);
  const ZoneId sealed(5);
  const ZoneId group(6);
  EXPECT_TRUE(mesh.is_sealed(sealed));
  EXPECT_FALSE(mesh.is_sealed(group));
  EXPECT_TRUE(mesh.is_group(group));
  EXPECT_FALSE(mesh.is_group(ZoneId(4)));
  for (const std::size_t t : {0U, 2U}) EXPECT_EQ(mesh.zone_at(TriangleId(t), 0.2F, 0.7F, true), group);
  for (const std::size_t t : {0U, 1U, 2U}) EXPECT_EQ(mesh.zone_at(TriangleId(t), 0.9F, 0.05F, false), sealed);
  EXPECT_EQ(mesh.zone_at(TriangleId(1), 0.9F, 0.05F, true), ZoneId(3));
  EXPECT_EQ(mesh.zone_at(TriangleId(3), 0.9F, 0.05F, true), ZoneId(4));
  EXPECT_FALSE(mesh.has_zones(TriangleId(3), false));
  EXPECT_DOUBLE_EQ(mesh.zone_area(group), 0.5 + 4.5);
  EXPECT_DOUBLE_EQ(mesh.zone_area(sealed), 0.5 + 2 + 4.5);
  EXPECT_LT((mesh.zone_normal(sealed) + Vec3::UnitZ()).norm(), 1e-15);
  const Vec3 centre = (0.5 * Vec3(1.0 / 3, 1.0 / 3, 1) + 4.5 * Vec3(1, 1, 3)) / 5;
  EXPECT_LT((mesh.zone_centroid(group) - centre).norm(), 1e-14);

  ZoneMesh cut_out(four_triangles(), two_groups());
  cut_out.set_solid_shares(std::vector<float>(7, 0.25F));
  EXPECT_DOUBLE_EQ(cut_out.zone_area(group), 0.25 * 5);
  EXPECT_LT((cut_out.zone_centroid(group) - centre).norm(), 1e-14) << "holes do not move it";
}

TEST(ZoneGroups, PointsOfAGroupAreUniformOverItsArea) {
  const ZoneMesh mesh(four_triangles(), two_groups());
  constexpr int kNumbers = 10'000;
  std::vector<int> count(4, 0);
  std::vector<double> sum(4, 0.0);
  for (int i = 0; i < kNumbers; ++i) {
    float u = (static_cast<float>(i) + 0.5F) / kNumbers;
    const SideCell cell = mesh.pick_cell(ZoneId(5), u);
    ASSERT_TRUE(u >= 0 && u < 1);
    EXPECT_FALSE(cell.front);
    EXPECT_EQ(cell.corners, CellCorners());
    ++count[cell.triangle.index()];
    sum[cell.triangle.index()] += static_cast<double>(u);
  }
  const double total = 7;
  const double area[] = {0.5, 2, 4.5, 0};
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_NEAR(count[t], kNumbers * area[t] / total, 1) << "triangle " << t;
    if (count[t] > 0) {
      EXPECT_NEAR(sum[t] / count[t], 0.5, 1e-3) << "uniform again, triangle " << t;
    }
  }
}

TEST(ZoneGroups, CellsAreAllThereWhateverTheirZones) {
  const ZoneMesh mesh(four_triangles(), two_groups());
  const ZoneCells cells(mesh);
  ASSERT_EQ(cells.size(), 2U + 8U + 2U + 1U);
  double area = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    area += cells.area(i);
    const SidePoint middle = cell_point(cells.cell(i), 1.0F / 3, 1.0F / 3);
    EXPECT_EQ(cells.zone(i), mesh.zone_at(middle.triangle, static_cast<float>(middle.at.u),
                                          static_cast<float>(middle.at.v), middle.front));
  }
  EXPECT_NEAR(area, 2 * (0.5 + 2 + 4.5) + 8, 1e-12);
}

TEST(ZoneGroups, WhatIsNoGroupIsRefused) {
  const auto refused = [](const ZoneGroups& groups) {
    BaseMesh base = four_triangles();
    base.triangles[2].surface = SurfaceId(1);
    EXPECT_THROW(ZoneMesh(std::move(base), groups), std::invalid_argument);
  };
  refused({.of_side = {0, kOwn, kOwn, kOwn, 0, kOwn, kOwn, kOwn}, .count = 1});     // two surfaces
  refused({.of_side = {0, kOwn, kOwn, 0, kOwn, kOwn, kOwn, kOwn}, .count = 1});     // front and back
  refused({.of_side = {kOwn, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn, 0}, .count = 1});  // no zones there
  refused({.of_side = {0, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn}, .count = 2});  // one without members
  refused({.of_side = {7, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn}, .count = 1});  // out of range
  refused({.of_side = {0, kOwn}, .count = 1});                                      // other sides
  refused({.of_side = {}, .count = 1});
  refused({.of_side = {0, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn, kOwn}, .count = 1, .sealed = 2});
}

}  // namespace
}  // namespace reemit
