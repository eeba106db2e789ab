#include "solver/gather/point_sampler.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr int kLog2Count = 4;
constexpr int kLog2Samples = 2;
constexpr std::uint64_t kGroup = 3;

using Point = std::array<float, 2>;

PointSampler member(std::uint32_t number, int replicate = 0) {
  return {1, RngPurpose::kPixelGroup, AmongNeighbours{kGroup, number, kLog2Count}, replicate, kLog2Samples};
}

/// Appends what the samples of a member are.
void add_places(std::uint32_t number, std::vector<Point>& points) {
  for (int s = 0; s < 1 << kLog2Samples; ++s) points.push_back(member(number).place(s));
}
void add_light(std::uint32_t number, std::vector<Point>& points) {
  for (int s = 0; s < 1 << kLog2Samples; ++s) {
    const std::array<float, 3> u = member(number).light(s, 0, 1);
    points.push_back({u[0], u[1]});
  }
}
/// Of two gather rays for each sample.
void add_hemisphere(std::uint32_t number, std::vector<Point>& points) {
  for (int s = 0; s < 1 << kLog2Samples; ++s)
    for (int ray = 0; ray < 2; ++ray) points.push_back(member(number).hemisphere(s, ray, 2));
}

/// Whether every division of the square into as many equal boxes as there are points, a power of two to each
/// side, has a point in every box: a (0,m,2)-net.
::testing::AssertionResult is_net(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  for (std::size_t columns = 1; columns <= n; columns *= 2) {
    const std::size_t rows = n / columns;
    std::set<std::size_t> hit;
    for (const auto& [x, y] : points) {
      const auto column = static_cast<std::size_t>(x * static_cast<float>(columns));
      const auto row = static_cast<std::size_t>(y * static_cast<float>(rows));
      hit.insert(row * columns + column);
    }
    if (hit.size() != n) {
      return ::testing::AssertionFailure()
             << n - hit.size() << " of " << columns << " x " << rows << " boxes have no point";
    }
  }
  return ::testing::AssertionSuccess();
}

TEST(PointSampler, members_of_a_group_have_nets_of_their_own_and_runs_of_them_share_one) {
  for (const auto add : {add_places, add_light, add_hemisphere})
    for (std::uint32_t run = 1; run <= 1U << kLog2Count; run *= 2)
      for (std::uint32_t first = 0; first < 1U << kLog2Count; first += run) {
        std::vector<Point> points;
        for (std::uint32_t number = first; number < first + run; ++number) add(number, points);
        EXPECT_TRUE(is_net(points)) << run << " members from " << first;
      }
}

TEST(PointSampler, members_by_themselves_share_no_net) {
  std::vector<Point> points;
  for (std::uint32_t pixel = 0; pixel < 1U << kLog2Count; ++pixel)
    for (int s = 0; s < 1 << kLog2Samples; ++s)
      points.push_back(PointSampler(1, RngPurpose::kPixel, pixel, 0, kLog2Samples).place(s));
  EXPECT_FALSE(is_net(points));
}

TEST(PointSampler, groups_and_replicates_have_other_points) {
  const PointSampler other_group(1, RngPurpose::kPixelGroup, AmongNeighbours{kGroup + 1, 0, kLog2Count}, 0,
                                 kLog2Samples);
  EXPECT_NE(member(0).place(0), other_group.place(0));
  EXPECT_NE(member(0).place(0), member(0, 1).place(0));
  EXPECT_NE(member(0).hemisphere(0, 0, 1), member(0, 1).hemisphere(0, 0, 1));
}

// Means of one sample of each member over replicates: each is uniform by itself, so x has mean 1/2 and
// variance 1/12. 4 standard errors: a false alarm once in 16,000 seeds; a bias of 2 % is 10 of them.
TEST(PointSampler, each_point_is_uniform) {
  constexpr int kReplicates = 80'000;
  double sum = 0;
  for (int r = 0; r < kReplicates; ++r) sum += static_cast<double>(member(5, r).place(1)[0]);
  const double error = std::sqrt(1.0 / 12 / kReplicates);
  EXPECT_NEAR(sum / kReplicates, 0.5, 4 * error);
  EXPECT_GT(std::abs(1.02 * sum / kReplicates - 0.5), 4 * error);
}

}  // namespace
}  // namespace reemit
