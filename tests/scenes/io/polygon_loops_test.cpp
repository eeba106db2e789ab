#include "scenes/io/common/polygon_loops.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scenes/model/measures.h"
#include "tests/scenes/io/face_area.h"

namespace reemit {
namespace {

Vec3 at(double x, double y) {
  return {x, y, 0};
}

// A 4 x 4 wall with a 2 x 2 window, tied to it by a seam from (0,4) to (1,1).
std::vector<Vec3> wall_with_seam() {
  return {at(0, 0), at(4, 0), at(4, 4), at(0, 4), at(1, 1), at(1, 3), at(3, 3), at(3, 1), at(1, 1), at(0, 4)};
}

TEST(SplitAtSeams, LeavesSimpleOutlinesAlone) {
  const Polygon triangle{{at(0, 0), at(1, 0), at(0, 1)}, {Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitX()}, {}};
  const auto result = split_at_seams(triangle);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_EQ(result[0].outer, triangle.outer);
  EXPECT_EQ(result[0].normals, triangle.normals);
}

TEST(SplitAtSeams, TurnsASeamIntoAHoleWhereverTheOutlineStarts) {
  std::vector<Vec3> outline = wall_with_seam();
  for (std::size_t start = 0; start < outline.size(); ++start) {
    const auto result = split_at_seams({outline, {}, {}});
    ASSERT_EQ(result.size(), 1U) << start;
    EXPECT_EQ(result[0].outer.size(), 4U) << start;
    ASSERT_EQ(result[0].holes.size(), 1U) << start;
    EXPECT_EQ(result[0].holes[0].size(), 4U) << start;
    EXPECT_TRUE(test::area_vector(result[0]).isApprox(Vec3(0, 0, 12))) << start;
    std::rotate(outline.begin(), outline.begin() + 1, outline.end());
  }
}

TEST(SplitAtSeams, FollowsSeamsFromHoleToHole) {
  // Seams: outline (0,0) -> (1,1) of the first window, its (2,2) -> (3,3) of the second.
  const std::vector<Vec3> outline = {at(0, 0), at(1, 1), at(1, 2), at(2, 2), at(3, 3), at(3, 4),
                                     at(4, 4), at(4, 3), at(3, 3), at(2, 2), at(2, 1), at(1, 1),
                                     at(0, 0), at(6, 0), at(6, 6), at(0, 6)};
  const auto result = split_at_seams({outline, {}, {}});
  ASSERT_EQ(result.size(), 1U);
  EXPECT_EQ(result[0].outer.size(), 4U);
  EXPECT_EQ(result[0].holes.size(), 2U);
  EXPECT_TRUE(test::area_vector(result[0]).isApprox(Vec3(0, 0, 34)));
}

TEST(SplitAtSeams, SeparatesIslandsAndGivesThemTheirHoles) {
  // A small square and, behind a seam, the wall with its window.
  std::vector<Vec3> outline = {at(-3, 0), at(-1, 0), at(-1, 2), at(-3, 2), at(-3, 0)};
  for (const Vec3& p : wall_with_seam()) outline.push_back(p);
  outline.push_back(at(0, 0));
  const auto result = split_at_seams({outline, {}, {}});
  ASSERT_EQ(result.size(), 2U);
  EXPECT_EQ(result[0].holes.size(), 1U);
  EXPECT_EQ(result[1].holes.size(), 0U);
  EXPECT_NEAR(test::total_area(result), 16, 1e-12);
}

TEST(SplitAtSeams, WindingDoesNotMakeAHole) {
  // The window runs like the wall around it.
  const std::vector<Vec3> same = {at(0, 0), at(4, 0), at(4, 4), at(0, 4), at(1, 1),
                                  at(3, 1), at(3, 3), at(1, 3), at(1, 1), at(0, 4)};
  const auto ring = split_at_seams({same, {}, {}});
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_EQ(ring[0].holes.size(), 1U);
  EXPECT_NEAR(test::total_area(ring), 12, 1e-12);
  // An island that runs against the larger one beside it is no hole, and turns its front to the same side.
  const std::vector<Vec3> islands = {at(0, 0), at(2, 0), at(2, 2), at(0, 2), at(0, 0),
                                     at(5, 0), at(5, 1), at(6, 1), at(6, 0), at(5, 0)};
  const auto two = split_at_seams({islands, {}, {}});
  ASSERT_EQ(two.size(), 2U);
  EXPECT_TRUE(two[0].holes.empty() && two[1].holes.empty());
  EXPECT_TRUE(loop_area(two[1].outer).isApprox(Vec3(0, 0, 1)));
  // A concave hole whose first corners do not say where it is.
  std::vector<Vec3> star = {at(0, 0), at(9, 0), at(9, 9), at(0, 9), at(0, 0)};
  for (const Vec3& p : {at(1, 1), at(4, 2), at(8, 1), at(5, 4), at(4, 8), at(4, 4), at(1, 1)})
    star.push_back(p);
  const auto starred = split_at_seams({star, {}, {}});
  ASSERT_EQ(starred.size(), 1U);
  EXPECT_EQ(starred[0].holes.size(), 1U);
}

TEST(SplitAtSeams, WithoutAFrontItStaysAsItIs) {
  const std::vector<Vec3> bow_tie = {at(0, 0), at(1, -1), at(1, 1), at(0, 0), at(-1, -1), at(-1, 1)};
  ASSERT_NEAR(loop_area(bow_tie).norm(), 0, 1e-15);
  const auto result = split_at_seams({bow_tie, {}, {}});
  ASSERT_EQ(result.size(), 1U);
  EXPECT_EQ(result[0].outer, bow_tie);
}

TEST(SplitAtSeams, DropsRepeatedCornersSpikesAndNothings) {
  const auto repeated = split_at_seams({{at(0, 0), at(0, 0), at(1, 0), at(1, 1), at(1, 1)}, {}, {}});
  ASSERT_EQ(repeated.size(), 1U);
  EXPECT_EQ(repeated[0].outer.size(), 3U);
  const auto spike = split_at_seams({{at(0, 0), at(1, 0), at(5, 0), at(1, 0), at(1, 1)}, {}, {}});
  ASSERT_EQ(spike.size(), 1U);
  EXPECT_EQ(spike[0].outer.size(), 3U);
  EXPECT_TRUE(split_at_seams({{at(0, 0), at(1, 0), at(0, 0)}, {}, {}}).empty());
  EXPECT_TRUE(split_at_seams({{at(0, 0), at(0, 0), at(-0.0, 0)}, {}, {}}).empty());
}

}  // namespace
}  // namespace reemit
