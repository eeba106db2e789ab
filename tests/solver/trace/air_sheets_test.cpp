#include "solver/trace/air_sheets.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(AirSheets, are_crossed_where_rays_pass_near_points) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto direction = [&] { return Vec3f(unit(random), unit(random), unit(random)).normalized(); };
  std::vector<MeasuringPoint> points;
  for (int i = 0; i < 144; ++i) {
    const Vec3f at(-0.4F + 0.07F * static_cast<float>(i % 12), -0.4F + 0.07F * static_cast<float>(i / 12),
                   0.1F);
    points.push_back({at, Vec3f::UnitZ()});
    points.push_back({at, -Vec3f::UnitZ()});  // the other side of the plane
  }
  for (int i = 0; i < 50; ++i)
    points.push_back({0.4F * Vec3f(unit(random), unit(random), unit(random)), direction()});
  constexpr float kReach = 0.1F;
  const AirSheets sheets(points, kReach);
  // Rounding may set some points of a plane on a sheet of their own.
  EXPECT_LT(sheets.count(), 60U);
  EXPECT_NE(sheets.sheet_of(0), sheets.sheet_of(1));
  std::size_t crossed = 0, crossed_grid = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3f from = 0.5F * Vec3f(unit(random), unit(random), unit(random));
    const Vec3f along = direction();
    const float length = 1 + unit(random);
    std::set<std::uint32_t> expected;
    std::set<std::uint32_t> doubtful;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float down = -points[i].normal.dot(along);
      const float way = points[i].normal.dot(from - points[i].place) / down;
      const float aside = (from + way * along - points[i].place).norm();
      const bool crosses = down > 0 && way > 0 && way < length && aside < kReach;
      if (crosses) expected.insert(sheets.sheet_of(i));
      if (std::min({std::fabs(way), std::fabs(way - length), std::fabs(aside - kReach)}) < 1e-4F)
        doubtful.insert(sheets.sheet_of(i));
    }
    std::set<std::uint32_t> found;
    for (const AirSheets::Crossing& at : sheets.crossings(from, along, length, kReach)) {
      EXPECT_TRUE(found.insert(at.sheet).second) << "told of twice";
      EXPECT_LT(sheets.normal(at.sheet).dot(along), 0);
    }
    for (const std::uint32_t sheet : expected)
      EXPECT_TRUE(found.contains(sheet) || doubtful.contains(sheet)) << "missed";
    for (const std::uint32_t sheet : found)
      EXPECT_TRUE(expected.contains(sheet) || doubtful.contains(sheet)) << "not crossed";
    crossed += found.size();
    for (const std::uint32_t sheet : found)
      if (sheet == sheets.sheet_of(0) || sheet == sheets.sheet_of(1)) ++crossed_grid;
  }
  EXPECT_GT(crossed, 300U);
  EXPECT_GT(crossed_grid, 40U);
}

}  // namespace
}  // namespace reemit
