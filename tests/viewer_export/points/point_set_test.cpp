#include "viewer_export/points/point_set.h"

#include <string>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

const Vec3 kUp{0, 1, 0};

TEST(PointSet, GridHasTheMiddlesOfItsFieldsRowByRow) {
  const PointSet grid = grid_points("desk", {Vec3(1, 0.85, 2), Vec3(3, 0, 0), Vec3(0, 0, 2), 3, 2}, kUp);
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_EQ(grid.name, "desk");
  EXPECT_TRUE(grid.places[0].isApprox(Vec3(1.5, 0.85, 2.5)));
  EXPECT_TRUE(grid.places[2].isApprox(Vec3(3.5, 0.85, 2.5)));
  EXPECT_TRUE(grid.places[3].isApprox(Vec3(1.5, 0.85, 3.5)));
}

TEST(PointSet, GridsFaceUpwardsHoweverTheirSidesAreGiven) {
  for (const bool turned : {false, true}) {
    const Vec3 a(3, 0, 0);
    const Vec3 b(0, 0, 2);
    const PointSet grid = grid_points("desk", {Vec3::Zero(), turned ? b : a, turned ? a : b, 2, 2}, kUp);
    EXPECT_TRUE(grid.normals.front().isApprox(kUp)) << turned;
  }
  // Upright ones as their sides say.
  const PointSet wall = grid_points("wall", {Vec3::Zero(), Vec3(3, 0, 0), Vec3(0, 2, 0), 2, 2}, kUp);
  EXPECT_TRUE(wall.normals.front().isApprox(Vec3(0, 0, 1)));
}

TEST(PointSet, GridWithoutAreaIsRefused) {
  EXPECT_THROW(grid_points("grid", {Vec3::Zero(), Vec3(1, 1, 0), Vec3(2, 2, 0), 2, 2}, kUp), InputError);
  EXPECT_THROW(grid_points("grid", {Vec3::Zero(), Vec3::Zero(), Vec3(2, 2, 0), 2, 2}, kUp), InputError);
  for (const int none : {0, -1}) {
    EXPECT_THROW(grid_points("grid", {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0), none, 2}, kUp), InputError);
    EXPECT_THROW(grid_points("grid", {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0), 2, none}, kUp), InputError);
  }
}

TEST(PointSet, GridsThatMemoryWillNotHoldAreRefused) {
  constexpr int kMost = 1'000'000;
  EXPECT_THROW(grid_points("grid", {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 0, 1), kMost, kMost}, kUp),
               ResourceError);
}

TEST(PointSet, ReadsPointsWithAnyDividers) {
  test::TempFolder folder;
  folder.write(
      "sensors.csv",
      "x;y;z;nx;ny;nz\r\n# by the window\r\n1.5, 0.85, 2, 0, 2, 0\r\n\r\n-1e-1;0;3;0;0;-1\n1 2 3 1 1 0");
  const PointSet points = read_points(folder / "sensors.csv");
  EXPECT_EQ(points.name, "sensors");
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points.places[0], Vec3(1.5, 0.85, 2));
  EXPECT_EQ(points.normals[0], Vec3(0, 1, 0));
  EXPECT_EQ(points.places[1], Vec3(-0.1, 0, 3));
  EXPECT_TRUE(points.normals[2].isApprox(Vec3(1, 1, 0).normalized()));
}

/// What is said of a file of points.
std::string problem_of(const std::string& text) {
  test::TempFolder folder;
  folder.write("p.txt", text);
  try {
    read_points(folder / "p.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PointSet, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(problem_of("0 0 0 0 1 0\n1 2 3\n").find("p.txt:2: 3 numbers"), std::string::npos);
  EXPECT_NE(problem_of("0 0 0 0 1 0\nx y z a b c\n").find("p.txt:2: not a line of numbers"),
            std::string::npos);
  EXPECT_NE(problem_of("0 0 zero 0 1 0\n").find("p.txt:1: not a line of numbers"), std::string::npos);
  EXPECT_NE(problem_of("0 0 nan 0 1 0\n").find("p.txt:1:"), std::string::npos);
  EXPECT_NE(problem_of("0 0 0 0 0 0\n").find("p.txt:1: the direction"), std::string::npos);
  EXPECT_NE(problem_of("1e30 0 0 0 1 0\n").find("p.txt:1: the place"), std::string::npos);
  EXPECT_NE(problem_of("# nothing\n").find("no point in it"), std::string::npos);
}

}  // namespace
}  // namespace reemit
