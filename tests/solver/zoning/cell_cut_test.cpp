// Cells are cut along the borders of shadows, and across their length where light is even.

#include "solver/zoning/cell_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/zones/zone_cost.h"
#include "tests/support/crate_room.h"

namespace reemit {
namespace {

using test::CrateRoom;

constexpr double kZoneArea = 1e-5;  // [m2]

/// A lamp at (0,0,5) above a tile of reflectance 0.5, and a screen that keeps its light from all x < 0.
struct HalfLitTile {
  explicit HalfLitTile(const std::array<Vec3, 3>& corners) : room_(0, 1) {
    room_.scene().surfaces.clear();
    const SurfaceId tile = room_.surface("tile", room_.material(0.5, 0, false));
    Surface& surface = room_.scene().surfaces[tile.index()];
    surface.positions.assign(corners.begin(), corners.end());
    surface.faces.emplace_back().outer = {0, 1, 2};
    room_.quad(room_.surface("screen", room_.material(0, 0, true)), {-2, -1, 2.5}, {2, 0, 0}, {0, 2, 0}, 1);
    room_.scene().lights.push_back(PointLight{"lamp", Vec3(0, 0, 5), Spectrum::Constant(1, 1)});
  }

  CellCut best() {
    const PilotLight pilot(room_.scene(), build_mesh(room_.scene(), {.zone_area = 100}), {});
    PilotLight::Looker looker(pilot);
    mesh_ = pilot.mesh().base();
    std::vector<SeenPoint> points;
    return best_cut({TriangleId(0), true, {}}, kZoneArea, pilot, looker, points);
  }
  const Scene& scene() { return room_.scene(); }
  Vec3 corner(std::size_t k) const { return mesh_.vertices[mesh_.triangles[0].vertex[k]]; }
  double area() const { return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm(); }

 private:
  CrateRoom room_;
  BaseMesh mesh_;
};

TEST(CellCut, LiesAlongTheBorderOfAShadow) {
  // The border x = 0 leads from the corner at the top to the middle of the edge opposite it, the shortest
  // one.
  const Vec3 left(-0.05, -0.2, 0);
  const Vec3 right(0.05, -0.2, 0);
  const Vec3 top(0, 0.2, 0);
  for (const std::array<Vec3, 3>& corners :
       {std::array{left, right, top}, {right, top, left}, {top, left, right}}) {
    HalfLitTile tile(corners);
    const CellCut cut = tile.best();
    EXPECT_LT((tile.corner(cut.corner) - top).norm(), 1e-9);
    // Both halves are lit evenly: all that light costs is saved, and place costs next to nothing. Of 8 points
    // the variance is estimated as 8/7 of what halves of four differ by.
    EXPECT_NEAR(cut.saved, 7.0 / 8 * cut.cost, 0.01 * cut.cost);
  }
}

TEST(CellCut, HalvesTheLongestEdgeWhereLightIsEven) {
  const Vec3 low(0.1, -0.2, 0);
  const Vec3 right(0.2, -0.1, 0);
  const Vec3 high(0.1, 0.2, 0);
  for (const std::array<Vec3, 3>& corners :
       {std::array{low, right, high}, {right, high, low}, {high, low, right}}) {
    HalfLitTile tile(corners);
    const CellCut cut = tile.best();
    EXPECT_LT((tile.corner(cut.corner) - right).norm(), 1e-9);
    // Place alone: the edges e0, e1 and the longest, a, become halves of a and the line m that is cut along.
    // Squares of edges before and after, over 36, times the area.
    const double a = (high - low).squaredNorm();
    const double others = (right - low).squaredNorm() + (high - right).squaredNorm();
    const double m = (0.5 * (high + low) - right).squaredNorm();
    const double saved = tile.area() / 36 * (a + others - 0.5 * (others + 2 * m + 0.5 * a));
    const double cost = tile.area() / 36 * (a + others);
    EXPECT_NEAR(cut.saved, saved, 0.05 * saved);
    EXPECT_NEAR(cut.cost, cost, 0.05 * cost);
  }
}

TEST(CellCut, HalvesKeepWhatWasSeenWhereItWas) {
  HalfLitTile tile({Vec3(-0.1, -0.2, 0), Vec3(0.2, -0.1, 0), Vec3(0, 0.2, 0)});
  const PilotLight pilot(tile.scene(), build_mesh(tile.scene(), {.zone_area = 100}), {});
  PilotLight::Looker looker(pilot);
  const auto x_of = [&](const SideCell& cell, const SeenPoint& point) {
    const SidePoint at = cell_point(cell, point.at.a, point.at.b);
    return pilot.mesh().point(at.triangle, at.at.u, at.at.v).x();
  };
  const SideCell cell{TriangleId(0), true, {}};
  std::vector<SeenPoint> first;
  const CellCut cut = best_cut(cell, kZoneArea, pilot, looker, first);
  const std::size_t seen = first.size();
  std::vector<SeenPoint> second = take_second_half(first, cut.corner);
  EXPECT_GT(first.size(), 0U);
  EXPECT_GT(second.size(), 0U);
  EXPECT_EQ(first.size() + second.size(), seen);
  const CellHalves halves = halves_of(cell.corners, cut.corner);
  for (auto& [corners, points] : {std::pair{halves.first, &first}, {halves.second, &second}}) {
    const std::size_t old = points->size();
    const SideCell half{cell.triangle, cell.front, corners};
    best_cut(half, kZoneArea, pilot, looker, *points);
    EXPECT_EQ(points->size(), std::max<std::size_t>(seen, old + 2));
    // The screen keeps all light from x < 0: old and new points alike.
    for (const SeenPoint& point : *points) {
      const double x = x_of(half, point);
      EXPECT_GE(std::min(point.at.a, std::min(point.at.b, 1 - point.at.a - point.at.b)), -1e-6F);
      EXPECT_EQ(point.first_look > 0, x > 0) << x;
      EXPECT_EQ(point.second_look > 0, x > 0) << x;
    }
  }
}

}  // namespace
}  // namespace reemit
