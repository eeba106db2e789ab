// Cells are cut along the borders of shadows, and across their length where light is even.

#include "solver/zoning/cell_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "mesh/zones/zone_cost.h"
#include "tests/support/crate_room.h"

namespace reemit {
namespace {

using test::CrateRoom;

constexpr double kZoneArea = 1e-5;                                          // [m2]
constexpr CellScale kScale{kZoneArea, std::numeric_limits<double>::max()};  // without vertices

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
    CellLooks looks;
    return best_cut({TriangleId(0), true, {}}, kScale, pilot, looker, looks);
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

/// Light is a function of place alone on this tile; every look is compared with it.
TEST(CellCut, HalvesKeepWhatWasSeenWhereItWas) {
  HalfLitTile tile({Vec3(-0.1, -0.2, 0), Vec3(0.2, -0.1, 0), Vec3(0.02, 0.2, 0)});
  const PilotLight pilot(tile.scene(), build_mesh(tile.scene(), {.zone_area = 100}), {});
  PilotLight::Looker looker(pilot);
  const auto is_lit = [&](const SideCell& cell, const InCell& place) {
    const SidePoint at = cell_point(cell, place.a, place.b);
    return pilot.mesh().point(at.triangle, at.at.u, at.at.v).x() > 0;
  };
  const SideCell cell{TriangleId(0), true, {}};
  const CellScale with_vertices{kZoneArea, 0};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    CellLooks looks;
    best_cut(cell, with_vertices, pilot, looker, looks);
    look_at_middles(cell, looker, looks);
    const CellHalves halves = halves_of(cell.corners, corner);
    auto [first, second] = looks_of_halves(looks, corner);
    EXPECT_EQ(first.points.size() + second.points.size(), looks.points.size());
    for (auto& [corners, known] : {std::pair{halves.first, &first}, {halves.second, &second}}) {
      const SideCell half{cell.triangle, cell.front, corners};
      const std::size_t old = known->points.size();
      for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(known->corner[k]);
      EXPECT_EQ(std::count_if(known->middle.begin(), known->middle.end(), [](const auto& m) { return m; }),
                1);
      best_cut(half, with_vertices, pilot, looker, *known);
      look_at_middles(half, looker, *known);
      EXPECT_EQ(known->points.size(), std::max(looks.points.size(), old + 2));
      for (const SeenPoint& point : known->points) {
        EXPECT_GE(std::min({point.at.a, point.at.b, 1 - point.at.a - point.at.b}), -1e-6F);
        EXPECT_EQ(point.seen.first_look > 0, is_lit(half, point.at));
        EXPECT_EQ(point.seen.second_look > 0, is_lit(half, point.at));
      }
      // None of the six places lies as near to the border of the shadow as corners are looked at inside.
      const std::array<InCell, 3> places{{{0.03F, 0.03F}, {0.94F, 0.03F}, {0.03F, 0.94F}}};
      const std::array<InCell, 3> middles{{{0.485F, 0.485F}, {0.03F, 0.485F}, {0.485F, 0.03F}}};
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(known->corner[k]->first_look > 0, is_lit(half, places[k])) << corner << k;
        EXPECT_EQ(known->middle[k]->second_look > 0, is_lit(half, middles[k])) << corner << k;
      }
    }
  }
}

/// An export is linear between its vertices, and what is dark at one of them alone makes all of a large cell
/// too dark. Only cuts of the edges at that corner help.
TEST(CellCut, ADarkCornerCostsAndIsCutOff) {
  const Vec3 dark(-0.03, -0.2, 0);
  const Vec3 right(0.4, -0.2, 0);
  const Vec3 high(0.4, 0.21, 0);
  for (const std::array<Vec3, 3>& corners :
       {std::array{dark, right, high}, {right, high, dark}, {high, dark, right}}) {
    HalfLitTile tile(corners);
    const CellCut zones = tile.best();
    const PilotLight pilot(tile.scene(), build_mesh(tile.scene(), {.zone_area = 100}), {});
    PilotLight::Looker looker(pilot);
    const SideCell cell{TriangleId(0), true, {}};
    CellLooks looks;
    const CellCut cut = best_cut(cell, {kZoneArea, 0}, pilot, looker, looks);
    EXPECT_GT((tile.corner(cut.corner) - dark).norm(), 1e-9);
    // The points see even light. What lies between the corners lacks the weight w of the dark one, of which
    // the mean square is 1/6; after the cut, 1/12.
    double mean = 0;
    double squares = 0;
    for (const SeenPoint& point : looks.points) {
      const std::array<float, 3> weight{1 - point.at.a - point.at.b, point.at.a, point.at.b};
      for (std::size_t k = 0; k < 3; ++k)
        if ((tile.corner(k) - dark).norm() < 1e-9)
          squares +=
              static_cast<double>(weight[k] * weight[k] * point.seen.first_look * point.seen.second_look);
      mean += static_cast<double>(point.seen.first_look);
    }
    const auto count = static_cast<double>(looks.points.size());
    EXPECT_NEAR(bent_variance(looks), squares / count, 0.02 * squares / count);
    EXPECT_NEAR(squares / count / std::pow(mean / count, 2), 1.0 / 6, 0.05);
    EXPECT_GT(cut.cost, 2 * zones.cost);
    EXPECT_GT(cut.saved, 0.25 * cut.cost);
    EXPECT_LT(cut.saved, 0.75 * cut.cost);
  }
}

}  // namespace
}  // namespace reemit
