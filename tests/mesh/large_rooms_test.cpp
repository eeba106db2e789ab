#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "mesh/geometry/edge_set.h"
#include "mesh/pieces/convex_region.h"
#include "mesh/pieces/loop_bins.h"
#include "tests/mesh/test_room.h"
#include "tests/support/refusal.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::TestRoom;
using testing::HasSubstr;

std::string refusal(const Scene& scene) {
  return test::refusal_of([&] { build_mesh(scene); });
}

std::vector<Vec3> on_a_circle(int corners) {
  std::vector<Vec3> out;
  for (int i = 0; i < corners; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / corners;
    out.emplace_back(std::cos(azimuth), std::sin(azimuth), 1);
  }
  return out;
}

TEST(LargeRooms, FloorIsCutUnderTensOfThousandsOfFeet) {
  TestRoom room;
  const MaterialId grey = room.material();
  room.polygon("floor", grey, floor_rectangle(0, 0, 80, 80));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(0, 0.5);
  constexpr int kRow = 71;
  constexpr int kFeet = kRow * kRow;  // 20164 lines in the floor
  for (int i = 0; i < kFeet; ++i) {
    const Vec3 at(0.5 + i % kRow + jitter(random), 0.5 + i / kRow + jitter(random), 1e-4);
    room.box("foot", grey, at, at + Vec3(0.05, 0.05, 0.4));
  }
  MeshSettings coarse;
  coarse.zone_area = 1;
  const MeshResult r = build_mesh(room.scene(), coarse);
  EXPECT_THAT(r.report.warnings, testing::IsEmpty());
  std::size_t under_feet = 0;
  for (std::size_t i = 0; i < r.mesh.triangle_count(); ++i)
    if (r.mesh.triangle(TriangleId(i)).surface.index() == 0 &&
        std::abs(r.mesh.triangle_area(TriangleId(i)) - 0.5 * 0.05 * 0.05) < 1e-9)
      ++under_feet;
  EXPECT_EQ(under_feet, 2U * kFeet);
}

TEST(LargeRooms, OutlineWithTooManyCrossingsIsRefusedByName) {
  TestRoom room;
  const SurfaceId id = room.surface("scribble", room.material());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  std::vector<Vec3> corners;
  for (int i = 0; i < 3000; ++i) corners.emplace_back(anywhere(random), anywhere(random), 0);
  room.add(id, corners);
  const std::string message = refusal(room.scene());
  EXPECT_THAT(message, HasSubstr("scribble"));
  EXPECT_THAT(message,
              HasSubstr("outline of 3000 corners crosses itself or its holes more than 100000 times"));
}

TEST(LargeRooms, LongOutlineThatCrossesItselfSeldomIsFilled) {
  TestRoom room;
  const SurfaceId id = room.surface("star", room.material());
  std::vector<Vec3> star;
  const std::vector<Vec3> circle = on_a_circle(3001);
  for (std::size_t i = 0; i < circle.size(); ++i) star.push_back(circle[7 * i % circle.size()]);
  room.add(id, star);
  EXPECT_EQ(refusal(room.scene()), "accepted");
}

TEST(LargeRooms, FanOfTooManyTrianglesIsRefusedByName) {
  TestRoom room;
  const SurfaceId id = room.surface("fan", room.material());
  Surface& fan = room.scene().surfaces[id.index()];
  fan.positions = on_a_circle(10000);
  const auto count = static_cast<std::uint32_t>(fan.positions.size());
  fan.positions.emplace_back(0, 0, 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    Face face;
    face.outer = {count, i, (i + 1) % count};
    fan.faces.push_back(face);
  }
  const std::string message = refusal(room.scene());
  EXPECT_THAT(message, HasSubstr("'fan'"));
  EXPECT_THAT(message, HasSubstr("comparisons for 10000 faces"));
  EXPECT_THAT(message, HasSubstr("join thin triangles"));
}

// Crossings of cuts that should be one point are some rounding apart; as a vertex each they were cut along by
// all of the others, and that took minutes.
TEST(LargeRooms, SquaresThatAllPierceEachOtherInOnePointShareAVertex) {
  TestRoom room;
  const SurfaceId id = room.surface("knot", room.material());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  constexpr int kSquares = 40;
  const Vec3 c(1, 2, 3);
  for (int i = 0; i < kSquares; ++i) {
    const Vec3 u = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Vec3 v = u.unitOrthogonal();
    room.add(id, {c - u - v, c + u - v, c + u + v, c - u + v});
  }
  const MeshResult r = build_mesh(room.scene());
  EXPECT_LT(test::worst_book_gap(r), test::kExact);
  EXPECT_NEAR(test::meshed_area(r.mesh, id), 4 * kSquares, 1e-6);
  const auto& vertices = r.mesh.base().vertices;
  EXPECT_EQ(
      std::count_if(vertices.begin(), vertices.end(), [&](const Vec3& p) { return (p - c).norm() < 1e-6; }),
      1);
  EXPECT_LT(r.mesh.triangle_count(), 500U * kSquares);
}

TEST(LargeRooms, NeighboursAlongEdgesAreNotCandidatesForContact) {
  VertexTable vertices(1e-7);
  const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    FacePiece piece;
    piece.loops = {{vertices.weld(a), vertices.weld(b), vertices.weld(c)}};
    return piece;
  };
  const FacePiece piece = triangle({0, 0, 0}, {1, 0, 0}, {0.3, 1, 0});
  const ConvexRegion region = ConvexRegion::of_piece(vertices, piece, PlaneFrame{}, 5e-4, 5e-6);
  const auto touches = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::array corners{a, b, c};
    return region.touches(corners.data(), corners.data() + 3);
  };
  EXPECT_FALSE(touches({0, 0, 0}, {1, 0, 0}, {0.5, -1, 0.2}));    // shares an edge
  EXPECT_FALSE(touches({0, 0, 0}, {-1, 0.1, 0}, {-1, -1, 0.2}));  // shares a corner
  EXPECT_FALSE(touches({0.3, 0.3, 6e-4}, {0.5, 0.3, 6e-4}, {0.4, 0.3, 1}));
  EXPECT_TRUE(touches({0.3, 0.3, 4e-4}, {0.5, 0.3, 4e-4}, {0.4, 0.3, 1}));  // stands on it
  EXPECT_TRUE(touches({0.3, 0.3, -1}, {0.5, 0.3, -1}, {0.4, 0.3, 1}));      // pierces it
  EXPECT_TRUE(touches({-1, 0.5, 1e-4}, {2, 0.5, 1e-4}, {0.5, 0.5, 1}));     // runs across it
}

TEST(LargeRooms, StripsOfALongLoopAnswerLikeTheLoop) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  std::vector<Vec2> loop;
  for (int i = 0; i < 200; ++i) loop.emplace_back(anywhere(random), std::round(8 * anywhere(random)) / 8);
  const LoopBins bins(loop);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 p(1.2 * anywhere(random),
                 i % 2 == 0 ? loop[static_cast<std::size_t>(i % 200)].y() : 1.2 * anywhere(random));
    ASSERT_EQ(bins.winding(p), winding_number(loop, p)) << p.transpose();
  }
}

TEST(LargeRooms, MeshingTellsHowFarItIsAndStopsWhenAsked) {
  TestRoom room;
  room.box("room", room.material(), {0, 0, 0}, {4, 3, 5}, true);
  std::vector<double> told;
  build_mesh(room.scene(), {}, WorkWatch([&](double done) { told.push_back(done); }));
  EXPECT_GE(told.size(), 5U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.front(), 0);
  EXPECT_LE(told.back(), 1);

  std::atomic<bool> interrupt{false};
  const auto stop_half_way = [&](double done) { interrupt = done > 0.5; };
  EXPECT_THROW(build_mesh(room.scene(), {}, WorkWatch(stop_half_way, StopToken(interrupt))), Interrupted);
}

TEST(LargeRooms, ManySquaresInOnePlaneKeepTheAreaOfTheirUnion) {
  TestRoom room;
  const MaterialId grey = room.material();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0, 4);
  constexpr int kSquares = 400;
  constexpr double kSide = 0.5;
  std::vector<Vec2> corners;
  std::vector<double> xs;
  std::vector<double> ys;
  for (int i = 0; i < kSquares; ++i) {
    const Vec2 p = corners.emplace_back(anywhere(random), anywhere(random));
    room.polygon("square", grey, floor_rectangle(p.x(), p.y(), p.x() + kSide, p.y() + kSide));
    for (const double shift : {0.0, kSide}) {
      xs.push_back(p.x() + shift);
      ys.push_back(p.y() + shift);
    }
  }
  std::sort(xs.begin(), xs.end());
  std::sort(ys.begin(), ys.end());
  double covered = 0;
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t k = 0; k + 1 < ys.size(); ++k) {
      const Vec2 middle(0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[k] + ys[k + 1]));
      if (std::any_of(corners.begin(), corners.end(), [&](const Vec2& c) {
            return (middle - c).minCoeff() > 0 && (middle - c).maxCoeff() < kSide;
          }))
        covered += (xs[i + 1] - xs[i]) * (ys[k + 1] - ys[k]);
    }
  const MeshResult r = build_mesh(room.scene());
  double meshed = 0;
  double removed = 0;
  for (const SurfaceAreas& areas : r.report.surfaces) {
    meshed += areas.meshed;
    removed += areas.removed;
  }
  EXPECT_NEAR(meshed, covered, 1e-5 * covered);
  EXPECT_NEAR(meshed + removed, kSquares * kSide * kSide, 1e-5 * covered);
  EXPECT_THAT(r.report.warnings, testing::ElementsAre(HasSubstr("lie in one plane")));
}

TEST(LargeRooms, StackOfSquaresIsCutWhereItIsSeen) {
  TestRoom room;
  const MaterialId grey = room.material();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> anywhere(0, 4);
  for (int i = 0; i < 1500; ++i) {
    const double x = anywhere(random);
    const double y = anywhere(random);
    room.polygon("square", grey, floor_rectangle(x, y, x + 0.5, y + 0.5));
  }
  MeshSettings coarse;
  coarse.zone_area = 1;
  const MeshResult r = build_mesh(room.scene(), coarse);
  // Cut along all of the more than 100,000 crossings, these would be more than 200,000 triangles.
  EXPECT_LT(r.mesh.triangle_count(), 6000U);
  EXPECT_GT(r.report.overlapping_faces, 1400U);
}

// Rectangles in one plane, some turned down, some luminous: whatever lines are left out, each keeps what the
// rule of the overlap gives it, one side or both.
TEST(LargeRooms, EveryFaceOfAStackKeepsTheSpotsItWins) {
  struct Rectangle {
    Vec2 low;
    Vec2 high;
    bool down;
    bool emits;
  };
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(0, 4);
  std::uniform_int_distribution<int> sixteenths(1, 24);
  for (int repeat = 0; repeat < 20; ++repeat) {
    TestRoom room;
    const MaterialId grey = room.material(false);
    const MaterialId lamp = room.material(false, 1);
    std::vector<Rectangle> stack;
    std::vector<double> xs;
    std::vector<double> ys;
    for (int i = 0; i < 60; ++i) {
      Vec2 low(anywhere(random), anywhere(random));
      if (repeat % 2 == 0) low = (16 * low).array().round() / 16;  // many edges and corners coincide
      const Vec2 size(sixteenths(random) / 16.0, sixteenths(random) / 16.0);
      stack.push_back({low, low + size, random() % 3 == 0, random() % 5 == 0});
      const Rectangle& r = stack.back();
      xs.insert(xs.end(), {r.low.x(), r.high.x()});
      ys.insert(ys.end(), {r.low.y(), r.high.y()});
      const std::vector<Vec3> outline = floor_rectangle(r.low.x(), r.low.y(), r.high.x(), r.high.y());
      room.polygon("sheet", r.emits ? lamp : grey, r.down ? test::reversed(outline) : outline);
    }
    std::sort(xs.begin(), xs.end());
    std::sort(ys.begin(), ys.end());
    std::vector<double> expected(stack.size(), 0.0);
    for (std::size_t i = 0; i + 1 < xs.size(); ++i)
      for (std::size_t k = 0; k + 1 < ys.size(); ++k) {
        const Vec2 middle(0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[k] + ys[k + 1]));
        // Of those that look up, of those that look down, and of all.
        std::array<std::size_t, 3> winner;
        winner.fill(stack.size());
        for (std::size_t p = 0; p < stack.size(); ++p) {
          if ((middle - stack[p].low).minCoeff() <= 0 || (stack[p].high - middle).minCoeff() <= 0) continue;
          for (std::size_t* best : {&winner[stack[p].down ? 1 : 0], &winner[2]})
            if (*best == stack.size() || (stack[p].emits && !stack[*best].emits)) *best = p;
        }
        if (winner[2] == stack.size()) continue;
        const double area = (xs[i + 1] - xs[i]) * (ys[k + 1] - ys[k]);
        expected[winner[2]] += area;
        const std::size_t other = winner[2] == winner[0] ? winner[1] : winner[0];
        if (other < stack.size() && !stack[winner[2]].emits) expected[other] += area;  // back to back
      }
    const MeshResult r = build_mesh(room.scene());
    for (std::size_t p = 0; p < stack.size(); ++p) {
      const double whole = (stack[p].high - stack[p].low).prod();
      EXPECT_NEAR(r.report.surfaces[p].meshed, expected[p], 1e-5) << "repeat " << repeat << ", face " << p;
      EXPECT_NEAR(r.report.surfaces[p].removed, whole - expected[p], 1e-5);
    }
  }
}

TEST(LargeRooms, AreaWithinATriangleIsThatOfTheClippedOutline) {
  VertexTable vertices(0);
  const auto loop = [&](const std::vector<Vec3>& corners) {
    Loop out;
    for (const Vec3& p : corners) out.push_back(vertices.weld(p));
    return out;
  };
  FacePiece piece;  // the letter U, three wide and three high, with a square hole in its left leg
  piece.loops = {
      loop({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}),
      loop({{0.25, 2, 0}, {0.75, 2, 0}, {0.75, 2.5, 0}, {0.25, 2.5, 0}})};
  const PlanarLoops loops(vertices, piece, PlaneFrame{});
  const auto area = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
    EXPECT_DOUBLE_EQ(area_within(loops, {a, b, c}), area_within(loops, {c, b, a}));
    return area_within(loops, {a, b, c});
  };
  EXPECT_NEAR(area({-10, -10}, {30, -10}, {-10, 30}), 7 - 0.25, 1e-12);  // all of it
  EXPECT_NEAR(area({0.5, 0.25}, {1, 0.25}, {0.5, 0.75}), 0.125, 1e-12);  // all of the triangle
  EXPECT_NEAR(area({0, 2}, {3, 2}, {0, 5}), 1 - 0.25 + 0.5, 1e-12);      // both legs, and the hole
  EXPECT_NEAR(area({1.2, 1.5}, {1.8, 1.5}, {1.5, 2.5}), 0, 1e-12);       // between the legs
  EXPECT_NEAR(area({4, 4}, {5, 4}, {4, 5}), 0, 1e-12);
}

TEST(LargeRooms, EdgesOfPolygonsAreNumberedOnce) {
  std::mt19937 random(7);
  std::uniform_int_distribution<std::uint32_t> vertex(0, 60);
  std::vector<std::array<std::uint32_t, 2>> given;
  std::set<std::array<std::uint32_t, 2>> expected;
  for (int i = 0; i < 500; ++i) {
    const std::uint32_t a = vertex(random);
    const std::uint32_t b = vertex(random);
    if (a == b) continue;
    given.push_back({a, b});
    expected.insert({std::min(a, b), std::max(a, b)});
  }
  const EdgeSet edges(61, [&](const auto& visit) {
    for (const auto& [a, b] : given) visit(a, b);
  });
  ASSERT_EQ(edges.edges().size(), expected.size());
  for (const auto& [a, b] : given) {
    const VertexEdge& edge = edges.edges()[edges.index(a, b)];
    EXPECT_EQ(edge.from, std::min(a, b));
    EXPECT_EQ(edge.to, std::max(a, b));
    EXPECT_EQ(edges.index(b, a), edges.index(a, b));
  }
}

}  // namespace
}  // namespace reemit
